`default_nettype none

/// `COPIES` of a block that holds one item for `LATENCY` cycles, in turns: each takes the item behind the one of the copy before it, so that together they take one every
/// ceil(LATENCY / COPIES) cycles, and no two give a result in the same cycle.
///
/// `turn_o` is one-hot: the copy that takes the next item. Results must always have a place; then a copy is free when its turn comes (`copy_turns_free`). `made_o` is the result of the copy
/// that gives one. One copy is always the one whose turn it is.
module copy_turns #(
  parameter int unsigned COPIES = 2,
  parameter int unsigned LATENCY = 11,
  parameter int unsigned W = 1
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  output logic [COPIES-1:0]        turn_o,
  // The copies' side.
  input  logic [COPIES-1:0]        ready_i,
  input  logic [COPIES-1:0]        made_valid_i,
  input  logic [COPIES-1:0][W-1:0] made_i,
  output logic                     made_valid_o,
  output logic [W-1:0]             made_o
);

  localparam int unsigned INTERVAL = (LATENCY + COPIES - 1) / COPIES;

  if (COPIES < 1 || INTERVAL < 2) begin : g_illegal
    $error("copy_turns: COPIES = %0d of LATENCY = %0d, must be at least 1 and fewer than LATENCY", COPIES, LATENCY);
  end

  assign made_valid_o = made_valid_i != '0;

  if (COPIES == 1) begin : g_alone
    logic unused_turns;
    assign unused_turns = ^{clk_i, rst_ni, valid_i};
    assign {turn_o, ready_o, made_o} = {1'b1, ready_i, made_i};
  end else begin : g_turns
    localparam int unsigned WAIT_W = $clog2(INTERVAL);
    // Cycles until the next item can be taken.
    logic [WAIT_W-1:0] wait_q;
    logic [COPIES-1:0] turn_q;

    assign ready_o = wait_q == '0;
    assign turn_o  = turn_q;

    always_comb begin
      made_o = '0;
      for (int unsigned k = 0; k < COPIES; k++) begin
        made_o = made_o | (made_i[k] & {W{made_valid_i[k]}});
      end
    end

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

    always_ff @(posedge clk_i) begin
      if (rst_ni) assert (!(valid_i && ready_o) || (turn_o & ready_i) != '0);
    end
  end

endmodule

`default_nettype wire
