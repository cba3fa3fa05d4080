`default_nettype none

/// The divisions of hits by `COPIES` of `hit_divide` that take turns, of `start_divide` where rays can start on a surface. Results always have a place.
///
/// What goes in with an item comes out with its result where `keep_i` says that it is to be kept: a hit with the division for its t. Other results come with anything.
/// Latency as of one; one is taken every ceil(latency / COPIES) cycles, with lod_pkg::DIVIDE_COPIES every DIVIDE_INTERVAL. Legal: COPIES 1 to 4.
module divide_copies #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned WITH_W = lod_pkg::KEPT_HIT_W,
  parameter int unsigned COPIES = lod_pkg::DIVIDE_COPIES
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic                       valid_i,
  output logic                       ready_o,
  input  lod_pkg::start_divide_in_t  in_i,
  input  logic [TAG_W-1:0]           tag_i,
  input  logic                       keep_i,
  input  logic [WITH_W-1:0]          with_i,
  output logic                       valid_o,
  output lod_pkg::hit_divide_out_t   out_o,
  output logic [TAG_W-1:0]           tag_o,
  output logic [WITH_W-1:0]          with_o
);

  localparam bit SECONDARY = lod_pkg::SECONDARY != 0;
  localparam int unsigned LATENCY = SECONDARY ? lod_pkg::START_DIVIDE_LATENCY : lod_pkg::HIT_DIVIDE_LATENCY;
  localparam int unsigned W = lod_pkg::HIT_DIVIDE_OUT_W + TAG_W + WITH_W;

  if (COPIES < 1 || COPIES > 4) begin : g_illegal_copies
    $error("divide_copies: COPIES = %0d, must be 1 to 4", COPIES);
  end
  if (COPIES == lod_pkg::DIVIDE_COPIES && lod_pkg::DIVIDE_INTERVAL != (LATENCY + COPIES - 1) / COPIES) begin : g_illegal_timing
    $error("divide_copies: lod_pkg::DIVIDE_INTERVAL must be %0d", (LATENCY + COPIES - 1) / COPIES);
  end

  logic [COPIES-1:0]             turn, ready, valid;
  logic [COPIES-1:0][W-1:0]      made;
  logic [COPIES-1:0][WITH_W-1:0] with_q;

  for (genvar k = 0; k < COPIES; k++) begin : g_copy
    lod_pkg::hit_divide_out_t out;
    logic [TAG_W-1:0]         tag;
    assign made[k] = {out, tag, with_q[k]};

    if (SECONDARY) begin : g_start_divide
      start_divide #(.TAG_W(TAG_W)) u_start_divide (
        .clk_i, .rst_ni,
        .valid_i(valid_i && ready_o && turn[k]), .ready_o(ready[k]), .in_i, .tag_i,
        .valid_o(valid[k]), .ready_i(1'b1), .out_o(out), .tag_o(tag)
      );
    end else begin : g_hit_divide
      logic unused_low;
      assign unused_low = ^in_i.low;
      hit_divide #(.TAG_W(TAG_W)) u_hit_divide (
        .clk_i, .rst_ni,
        .valid_i(valid_i && ready_o && turn[k]), .ready_o(ready[k]), .in_i({in_i.numerator, in_i.denominator}), .tag_i,
        .valid_o(valid[k]), .ready_i(1'b1), .out_o(out), .tag_o(tag)
      );
    end

    always_ff @(posedge clk_i) begin
      if (keep_i && turn[k]) with_q[k] <= with_i;
    end
  end

  copy_turns #(.COPIES(COPIES), .LATENCY(LATENCY), .W(W)) u_turns (
    .clk_i, .rst_ni, .valid_i, .ready_o, .turn_o(turn),
    .ready_i(ready), .made_valid_i(valid), .made_i(made), .made_valid_o(valid_o), .made_o({out_o, tag_o, with_o})
  );

endmodule

`default_nettype wire
