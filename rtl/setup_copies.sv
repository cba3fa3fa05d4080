`default_nettype none

/// The constants of rays by `COPIES` of `ray_setup` that take turns, of `start_setup` where rays can start on a surface. Results always have a place.
///
/// Latency as of one; one is taken every ceil(latency / COPIES) cycles, with lod_pkg::SETUP_COPIES every SETUP_INTERVAL. Legal: COPIES 1 to 4.
module setup_copies #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned COPIES = lod_pkg::SETUP_COPIES
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  input  logic                      valid_i,
  output logic                      ready_o,
  input  lod_pkg::start_setup_in_t  in_i,
  input  logic [TAG_W-1:0]          tag_i,
  output logic                      valid_o,
  output lod_pkg::ray_setup_out_t   out_o,
  output logic [TAG_W-1:0]          tag_o
);

  localparam bit SECONDARY = lod_pkg::SECONDARY != 0;
  localparam int unsigned LATENCY = SECONDARY ? lod_pkg::START_SETUP_LATENCY : lod_pkg::RAY_SETUP_LATENCY;
  localparam int unsigned W = lod_pkg::RAY_SETUP_OUT_W + TAG_W;

  if (COPIES < 1 || COPIES > 4) begin : g_illegal_copies
    $error("setup_copies: COPIES = %0d, must be 1 to 4", COPIES);
  end
  if (COPIES == lod_pkg::SETUP_COPIES && lod_pkg::SETUP_INTERVAL != (LATENCY + COPIES - 1) / COPIES) begin : g_illegal_timing
    $error("setup_copies: lod_pkg::SETUP_INTERVAL must be %0d", (LATENCY + COPIES - 1) / COPIES);
  end

  logic [COPIES-1:0]        turn, ready, valid;
  logic [COPIES-1:0][W-1:0] made;

  for (genvar k = 0; k < COPIES; k++) begin : g_copy
    lod_pkg::ray_setup_out_t out;
    logic [TAG_W-1:0]        tag;
    assign made[k] = {out, tag};

    if (SECONDARY) begin : g_start_setup
      start_setup #(.TAG_W(TAG_W)) u_start_setup (
        .clk_i, .rst_ni,
        .valid_i(valid_i && ready_o && turn[k]), .ready_o(ready[k]), .in_i, .tag_i,
        .valid_o(valid[k]), .ready_i(1'b1), .out_o(out), .tag_o(tag)
      );
    end else begin : g_ray_setup
      logic unused_fraction;
      assign unused_fraction = ^in_i.start.fraction;
      ray_setup #(.TAG_W(TAG_W)) u_ray_setup (
        .clk_i, .rst_ni,
        .valid_i(valid_i && ready_o && turn[k]), .ready_o(ready[k]), .in_i({in_i.start.point, in_i.direction}), .tag_i,
        .valid_o(valid[k]), .ready_i(1'b1), .out_o(out), .tag_o(tag)
      );
    end
  end

  copy_turns #(.COPIES(COPIES), .LATENCY(LATENCY), .W(W)) u_turns (
    .clk_i, .rst_ni, .valid_i, .ready_o, .turn_o(turn),
    .ready_i(ready), .made_valid_i(valid), .made_i(made), .made_valid_o(valid_o), .made_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
