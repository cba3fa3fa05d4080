`default_nettype none

/// The clock of a block: on in reset, while an item is offered, and from the cycle in which one is taken to that in which the last result leaves.
///
/// `MOST` items at a time at most. Blocks whose results always have a place keep nothing after that: counters of theirs have run out by then, as no interval is longer than the latency.
module block_clock #(
  parameter int unsigned MOST = 1,
  parameter bit GATED = 1'b0
) (
  input  logic clk_i,
  input  logic rst_ni,
  input  logic valid_i,
  input  logic ready_i,
  input  logic made_i,
  output logic clk_o
);

  if (GATED) begin : g_counted
    localparam int unsigned COUNT_W = $clog2(MOST + 1);
    logic [COUNT_W-1:0] inside_q;

    always_ff @(posedge clk_i) begin
      if (!rst_ni) inside_q <= '0;
      else inside_q <= inside_q + COUNT_W'(valid_i && ready_i) - COUNT_W'(made_i);
    end

    clock_gate #(.GATED(1'b1)) u_gate (.clk_i, .enable_i(!rst_ni || valid_i || inside_q != '0), .clk_o);
  end else begin : g_always
    logic unused_use;
    assign unused_use = ^{rst_ni, valid_i, ready_i, made_i};
    assign clk_o      = clk_i;
  end

endmodule

`default_nettype wire
