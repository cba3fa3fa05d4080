`default_nettype none

/// The way of a block's results back to those who asked for them, who always have a place: wires, or a register if there are two `LINK_REGISTERS`.
module shared_output #(
  parameter int unsigned W = 1,
  parameter int unsigned TAG_W = lod_pkg::CONTEXT_W
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  input  logic [W-1:0]     out_i,
  input  logic [TAG_W-1:0] tag_i,
  output logic             valid_o,
  output logic [W-1:0]     out_o,
  output logic [TAG_W-1:0] tag_o
);

  if (lod_pkg::LINK_REGISTERS > 1) begin : g_register
    logic             valid_q;
    logic [W-1:0]     out_q;
    logic [TAG_W-1:0] tag_q;

    assign {valid_o, out_o, tag_o} = {valid_q, out_q, tag_q};

    always_ff @(posedge clk_i) begin
      valid_q <= rst_ni && valid_i;
      out_q   <= out_i;
      tag_q   <= tag_i;
    end
  end else begin : g_wires
    logic unused_clock;
    assign unused_clock            = clk_i ^ rst_ni;
    assign {valid_o, out_o, tag_o} = {valid_i, out_i, tag_i};
  end

endmodule

`default_nettype wire
