`default_nettype none

/// Three passes over one item: it goes through in passes 0, 1 and 2, each when ready_i, and makes room for the next item with the last.
///
/// busy_o: an item is going through, and pass_o says in which pass; what the item is its user keeps, and takes with valid_i && ready_o.
module three_passes (
  input  logic       clk_i,
  input  logic       rst_ni,
  input  logic       valid_i,
  output logic       ready_o,
  output logic       busy_o,
  input  logic       ready_i,
  output logic [1:0] pass_o
);

  logic       busy_q;
  logic [1:0] pass_q;
  assign busy_o  = busy_q;
  assign pass_o  = pass_q;
  assign ready_o = !busy_q || (ready_i && pass_q == 2);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      busy_q <= 1'b0;
      pass_q <= '0;
    end else if (ready_o) begin
      busy_q <= valid_i;
      pass_q <= '0;
    end else if (ready_i) begin
      pass_q <= pass_q + 1;
    end
  end

endmodule

`default_nettype wire
