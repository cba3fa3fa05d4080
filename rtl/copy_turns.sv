`default_nettype none

/// Turns of `COPIES` of a block that holds one item for `LATENCY` cycles: each takes the item behind the one of the copy before it, so that together they take one every
/// ceil(LATENCY / COPIES) cycles, and no two give a result in the same cycle.
///
/// `turn_o` is one-hot: the copy that takes the next item. Its results must always have a place; then it is free when its turn comes (`copy_turns_free`).
module copy_turns #(
  parameter int unsigned COPIES = 2,
  parameter int unsigned LATENCY = 11
) (
  input  logic              clk_i,
  input  logic              rst_ni,
  input  logic              valid_i,
  output logic              ready_o,
  output logic [COPIES-1:0] turn_o
);

  localparam int unsigned INTERVAL = (LATENCY + COPIES - 1) / COPIES;
  localparam int unsigned WAIT_W = $clog2(INTERVAL);

  if (COPIES < 2 || INTERVAL < 2) begin : g_illegal
    $error("copy_turns: COPIES = %0d of LATENCY = %0d, must be at least 2 and fewer than LATENCY", COPIES, LATENCY);
  end

  // Cycles until the next item can be taken.
  logic [WAIT_W-1:0] wait_q;
  logic [COPIES-1:0] turn_q;

  assign ready_o = wait_q == '0;
  assign turn_o  = turn_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      wait_q <= '0;
      turn_q <= COPIES'(1);
    end else if (!ready_o) wait_q <= wait_q - WAIT_W'(1);
    else if (valid_i) begin
      wait_q <= WAIT_W'(INTERVAL - 1);
      turn_q <= {turn_q[COPIES-2:0], turn_q[COPIES-1]};
    end
  end

endmodule

`default_nettype wire
