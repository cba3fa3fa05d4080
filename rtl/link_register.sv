`default_nettype none

/// A register before a block that takes an input every `INTERVAL` cycles whatever happens, as those do whose results always have a place. What is taken is there in the next cycle, for that
/// one, and the block takes it then: nothing here waits.
module link_register #(
  parameter int unsigned W = 1,
  parameter int unsigned INTERVAL = 1
) (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic         valid_i,
  output logic         ready_o,
  input  logic [W-1:0] data_i,
  output logic         valid_o,
  input  logic         ready_i,
  output logic [W-1:0] data_o
);

  localparam int unsigned WAIT_W = $clog2(INTERVAL + 1);

  // Cycles until the block takes an input again.
  logic [WAIT_W-1:0] wait_q;
  logic              valid_q;
  logic [W-1:0]      data_q;

  assign ready_o = wait_q == '0;
  assign valid_o = valid_q;
  assign data_o  = data_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
      wait_q  <= '0;
    end else begin
      valid_q <= valid_i && ready_o;
      if (!ready_o) wait_q <= wait_q - WAIT_W'(1);
      else if (valid_i) wait_q <= WAIT_W'(INTERVAL - 1);
    end
    data_q <= data_i;
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) assert (!valid_q || ready_i);
  end

endmodule

`default_nettype wire
