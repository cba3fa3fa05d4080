`default_nettype none

/// Ray against one box of 32-bit coordinates: the full-precision variant of `box_test`. Twin of src/block/box_test32.rs (paper section 6.1).
///
/// With axes mirrored so that d >= 0 and sides relative to the origin: hit iff near_i d_j <= far_j d_i for all i != j and far_j >= 0.
/// `t_near` from floor(near_i / 2^16). Legal: |v| < 2^31, lo <= hi; constants from `ray_setup`. Latency BOX_TEST32_LATENCY; interval 1. 48 multipliers for the planes, 3 for t_near.
module box_test32 #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  lod_pkg::box_test32_in_t in_i,
  input  logic [TAG_W-1:0]        tag_i,
  output logic                    valid_o,
  input  logic                    ready_i,
  output lod_pkg::box_test_out_t  out_o,
  output logic [TAG_W-1:0]        tag_o
);

  localparam int unsigned W = lod_pkg::POINT_W / 3;
  localparam int unsigned D_W = 30;
  localparam int unsigned NEAR_W = 16;
  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  // Differences of 32-bit coordinates; times 30 bits unsigned.
  localparam int unsigned SIDE_W = W + 1;
  localparam int unsigned PRODUCT_W = SIDE_W + D_W + 1;
  // Sides and directions come from afar: registers of its own beside each of the 48 multipliers.
  localparam int unsigned FACTOR_STAGES = 1;
  localparam int unsigned PRODUCT_LATENCY = FACTOR_STAGES + lod_pkg::multiplier_latency(SIDE_W, D_W + 1);
  localparam int unsigned WAIT = 1 + lod_pkg::ENTRY_DISTANCE_LATENCY - PRODUCT_LATENCY - 2;
  localparam int unsigned LATENCY = 3 + lod_pkg::ENTRY_DISTANCE_LATENCY + 1;
  if (lod_pkg::BOX_TEST32_LATENCY != LATENCY) begin : g_illegal_latency
    $error("box_test32: lod_pkg::BOX_TEST32_LATENCY must be %0d", LATENCY);
  end

  // Stage 1: the box in mirrored axes; |v| < 2^31, so 32 bits hold the negatives.
  logic [2:0]            mirror;
  logic [2:0][D_W-1:0]   d, d_mirror, d_q;
  logic [2:0][W-1:0]     origin, origin_q, stored_lo, stored_hi, lo, hi, lo_q, hi_q;
  logic [2:0][lod_pkg::RECIPROCAL_W-1:0] reciprocal, reciprocal_mirror, reciprocal_q;
  logic                  valid_mirror, ready_mirror;
  assign mirror     = {in_i.ray.z.mirror, in_i.ray.y.mirror, in_i.ray.x.mirror};
  assign d          = {in_i.ray.z.d, in_i.ray.y.d, in_i.ray.x.d};
  assign origin     = {in_i.ray.z.origin, in_i.ray.y.origin, in_i.ray.x.origin};
  assign reciprocal = {in_i.ray.z.reciprocal, in_i.ray.y.reciprocal, in_i.ray.x.reciprocal};
  assign stored_lo  = {in_i.lo.z, in_i.lo.y, in_i.lo.x};
  assign stored_hi  = {in_i.hi.z, in_i.hi.y, in_i.hi.x};
  for (genvar k = 0; k < 3; k++) begin : g_mirror
    assign lo[k] = mirror[k] ? -stored_hi[k] : stored_lo[k];
    assign hi[k] = mirror[k] ? -stored_lo[k] : stored_hi[k];
  end
  pipe_stage #(.W(3 * (3 * W + D_W + lod_pkg::RECIPROCAL_W))) u_mirror (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({lo, hi, origin, d, reciprocal}),
    .valid_o(valid_mirror), .ready_i(ready_mirror), .data_o({lo_q, hi_q, origin_q, d_mirror, reciprocal_mirror})
  );

  // Stage 2: sides relative to the origin.
  logic [2:0][SIDE_W-1:0] near, near_q, far, far_q;
  logic                   valid_side, ready_side;
  for (genvar k = 0; k < 3; k++) begin : g_side
    logic signed [W-1:0] low, high, from;
    assign {low, high, from} = {lo_q[k], hi_q[k], origin_q[k]};
    assign near[k] = SIDE_W'(low) - SIDE_W'(from);
    assign far[k]  = SIDE_W'(high) - SIDE_W'(from);
  end
  pipe_stage #(.W(3 * (2 * SIDE_W + D_W + lod_pkg::RECIPROCAL_W))) u_side (
    .clk_i, .rst_ni, .valid_i(valid_mirror), .ready_o(ready_mirror), .data_i({near, far, d_mirror, reciprocal_mirror}),
    .valid_o(valid_side), .ready_i(ready_side), .data_o({near_q, far_q, d_q, reciprocal_q})
  );

  // Distances to the near sides, 0 if behind: floor(33 bits / 2^16) is 17 bits signed, 16 if not negative.
  logic [2:0][NEAR_W-1:0] distance, distance_q;
  logic [2:0][lod_pkg::RECIPROCAL_W-1:0] reciprocal_distance;
  logic                   valid_distance, ready_distance, valid_last, ready_last;
  logic [T_W-1:0]         entry;
  for (genvar k = 0; k < 3; k++) begin : g_distance
    assign distance[k] = near_q[k][SIDE_W-1] ? '0 : near_q[k][SIDE_W-2:lod_pkg::BOX_SHIFT];
  end
  pipe_stage #(.W(3 * (NEAR_W + lod_pkg::RECIPROCAL_W))) u_distance (
    .clk_i, .rst_ni, .valid_i(valid_side), .ready_o(ready_side), .data_i({distance, reciprocal_q}),
    .valid_o(valid_distance), .ready_i(ready_distance), .data_o({distance_q, reciprocal_distance})
  );
  entry_distance u_entry (
    .clk_i, .rst_ni, .valid_i(valid_distance), .ready_o(ready_distance), .near_i(distance_q), .reciprocal_i(reciprocal_distance),
    .valid_o(valid_last), .ready_i(ready_last), .t_near_o(entry)
  );

  // Six pairs of axes (I, J): near_I d_J against far_J d_I.
  logic [5:0] passes, ready_low, valid_low, ready_high, valid_high;
  logic       ahead, ahead_there, slabs, slabs_q, ready_product, valid_passes, ready_passes, valid_slabs, ready_slabs, slabs_last;
  logic [6:0] passes_q;
  for (genvar k = 0; k < 6; k++) begin : g_pair
    localparam int unsigned I = k < 3 ? (k + 1) % 3 : (k + 2) % 3;
    localparam int unsigned J = k < 3 ? (k + 2) % 3 : (k + 1) % 3;
    logic signed [PRODUCT_W-1:0] low, high;
    multiplier #(.A_W(SIDE_W), .B_W(D_W + 1), .FACTOR_STAGES(FACTOR_STAGES)) u_low (
      .clk_i, .rst_ni, .valid_i(valid_side), .ready_o(ready_low[k]), .a_i(near_q[I]), .b_i({1'b0, d_q[J]}),
      .valid_o(valid_low[k]), .ready_i(ready_product), .product_o(low)
    );
    multiplier #(.A_W(SIDE_W), .B_W(D_W + 1), .FACTOR_STAGES(FACTOR_STAGES)) u_high (
      .clk_i, .rst_ni, .valid_i(valid_side), .ready_o(ready_high[k]), .a_i(far_q[J]), .b_i({1'b0, d_q[I]}),
      .valid_o(valid_high[k]), .ready_i(ready_product), .product_o(high)
    );
    assign passes[k] = low <= high;
  end
  assign ahead = !(far_q[2][SIDE_W-1] || far_q[1][SIDE_W-1] || far_q[0][SIDE_W-1]);
  pipe_delay #(.W(1), .STAGES(PRODUCT_LATENCY)) u_ahead (
    .clk_i, .rst_ni, .valid_i(valid_side), .ready_o(), .data_i(ahead), .valid_o(), .ready_i(ready_product), .data_o(ahead_there)
  );
  pipe_skid #(.W(7)) u_passes (
    .clk_i, .rst_ni, .valid_i(valid_low[0]), .ready_o(ready_product), .data_i({ahead_there, passes}),
    .valid_o(valid_passes), .ready_i(ready_passes), .data_o(passes_q)
  );
  assign slabs = passes_q == '1;
  pipe_stage #(.W(1)) u_slabs (
    .clk_i, .rst_ni, .valid_i(valid_passes), .ready_o(ready_passes), .data_i(slabs),
    .valid_o(valid_slabs), .ready_i(ready_slabs), .data_o(slabs_q)
  );
  pipe_delay #(.W(1), .STAGES(WAIT)) u_wait (
    .clk_i, .rst_ni, .valid_i(valid_slabs), .ready_o(ready_slabs), .data_i(slabs_q), .valid_o(), .ready_i(ready_last), .data_o(slabs_last)
  );

  // Stage last: early termination. t_near 2^18 <= t_max iff t_near <= floor(t_max / 2^18).
  logic               hit;
  logic [T_W-1:0]     t_last, t_near;
  logic [TAG_W-1:0]   tag_last;
  pipe_delay #(.W(T_W + TAG_W), .STAGES(LATENCY - 1), .SKIDS(lod_pkg::BOX_TEST32_SKIDS)) u_beside (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({in_i.t_max[lod_pkg::RAY_T_W-1:lod_pkg::T_NEAR_TO_T_SHIFT], tag_i}),
    .valid_o(), .ready_i(ready_last), .data_o({t_last, tag_last})
  );
  assign hit    = slabs_last && entry <= t_last;
  assign t_near = hit ? entry : '0;
  pipe_stage #(.W(1 + T_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_last), .ready_o(ready_last), .data_i({hit, t_near, tag_last}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

  // Full-precision boxes need neither the moment nor the rounded origin.
  logic unused;
  assign unused = ^{in_i.ray.moment, in_i.ray.x.ceil, in_i.ray.y.ceil, in_i.ray.z.ceil, in_i.t_max[lod_pkg::T_NEAR_TO_T_SHIFT-1:0],
                    valid_low[5:1], ready_low, valid_high, ready_high};

endmodule

`default_nettype wire
