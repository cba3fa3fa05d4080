`default_nettype none

/// Ray against one 16-bit box: exact, division-free, closed. Twin of src/block/box_test.rs (paper section 3.4, docs/numbers.md "Box test").
///
/// With axes mirrored so that d >= 0: hit iff lo_i d_j - hi_j d_i <= floor(c_ij / 2^16) for all i != j and hi_j >= ceil(x_j / 2^16); c_ji = -c_ij.
/// `t_near` from `entry_distance`; missed too if t_near 2^18 > t_max. A miss gives t_near = 0.
/// Legal: box codes in +-32767, lo <= hi; constants from `ray_setup`. Latency BOX_TEST_LATENCY; interval 1. 24 multipliers for the planes, 3 for t_near.
module box_test #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   valid_i,
  output logic                   ready_o,
  input  lod_pkg::box_test_in_t  in_i,
  input  logic [TAG_W-1:0]       tag_i,
  output logic                   valid_o,
  input  logic                   ready_i,
  output lod_pkg::box_test_out_t out_o,
  output logic [TAG_W-1:0]       tag_o
);

  localparam int unsigned CODE_W = lod_pkg::CODE3_W / 3;
  localparam int unsigned D_ZEROS = lod_pkg::DIRECTION_ZEROS;
  localparam int unsigned D_W = 30 - D_ZEROS;
  localparam int unsigned CEIL_W = 17;
  localparam int unsigned NEAR_W = 16;
  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  localparam int unsigned MOMENT_W = lod_pkg::MOMENT_W / 3;
  // 16 bits times 30 unsigned: below 2^45 in magnitude, their differences below 2^46; floor(c / 2^16) and its negative: 47 bits.
  localparam int unsigned PRODUCT_W = CODE_W + D_W + 1;
  localparam int unsigned LIMIT_W = MOMENT_W - lod_pkg::BOX_SHIFT - D_ZEROS;
  // Codes and directions come from afar: registers of its own beside each multiplier; all together takes as long as `u_entry`.
  localparam int unsigned FACTOR_STAGES = 1;
  localparam int unsigned PRODUCT_LATENCY = lod_pkg::ENTRY_DISTANCE_LATENCY - 2;
  localparam int unsigned PRODUCT_STAGES = PRODUCT_LATENCY - FACTOR_STAGES - lod_pkg::multiplier_latency(CODE_W, D_W + 1) + 1;
  localparam int unsigned LATENCY = 1 + 1 + lod_pkg::ENTRY_DISTANCE_LATENCY + 1;
  if (lod_pkg::BOX_TEST_LATENCY != LATENCY) begin : g_illegal_latency
    $error("box_test: lod_pkg::BOX_TEST_LATENCY must be %0d", LATENCY);
  end

  // Stage 1: the box in mirrored axes: -hi and -lo where the ray runs backwards. Codes keep to +-32767, so 16 bits hold them.
  logic [2:0]               mirror;
  logic [2:0][D_W-1:0]      d, d_q;
  logic [2:0][CEIL_W-1:0]   ceil, ceil_q;
  logic [2:0][lod_pkg::RECIPROCAL_W-1:0] reciprocal, reciprocal_q;
  logic [2:0][CODE_W-1:0]   stored_lo, stored_hi, lo, hi, lo_q, hi_q;
  logic [2:0][MOMENT_W-1:0] moment;
  logic [2:0][LIMIT_W-1:0]  limit, limit_q;
  logic [2:0]               cut, cut_q;
  logic                     valid_mirror, ready_mirror;
  assign mirror     = {in_i.ray.z.mirror, in_i.ray.y.mirror, in_i.ray.x.mirror};
  assign d          = {in_i.ray.z.d[29:D_ZEROS], in_i.ray.y.d[29:D_ZEROS], in_i.ray.x.d[29:D_ZEROS]};
  assign ceil       = {in_i.ray.z.ceil, in_i.ray.y.ceil, in_i.ray.x.ceil};
  assign reciprocal = {in_i.ray.z.reciprocal, in_i.ray.y.reciprocal, in_i.ray.x.reciprocal};
  assign stored_lo  = {in_i.bounds.lo.z, in_i.bounds.lo.y, in_i.bounds.lo.x};
  assign stored_hi  = {in_i.bounds.hi.z, in_i.bounds.hi.y, in_i.bounds.hi.x};
  // Plane k has the axes after k: c_yz, c_zx, c_xy.
  assign moment     = {in_i.ray.moment.z, in_i.ray.moment.y, in_i.ray.moment.x};
  for (genvar k = 0; k < 3; k++) begin : g_mirror
    assign lo[k]    = mirror[k] ? -stored_hi[k] : stored_lo[k];
    assign hi[k]    = mirror[k] ? -stored_lo[k] : stored_hi[k];
    assign limit[k] = moment[k][MOMENT_W-1:lod_pkg::BOX_SHIFT+D_ZEROS];
    // Below the zeros of origin and direction nothing can be cut off.
    assign cut[k]   = moment[k][lod_pkg::BOX_SHIFT+D_ZEROS-1:0] >> (lod_pkg::COORDINATE_ZEROS + D_ZEROS) != '0;
  end
  pipe_stage #(.W(3 * (2 * CODE_W + D_W + CEIL_W + lod_pkg::RECIPROCAL_W + LIMIT_W + 1))) u_mirror (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({lo, hi, d, ceil, reciprocal, limit, cut}),
    .valid_o(valid_mirror), .ready_i(ready_mirror), .data_o({lo_q, hi_q, d_q, ceil_q, reciprocal_q, limit_q, cut_q})
  );

  // Stage 2: distances to the near sides, 0 if behind; far sides not behind; limits of the turned pairs, floor(-c / 2^16) = -floor(c / 2^16) - (anything cut off).
  logic [2:0][NEAR_W-1:0]  near, near_q;
  logic [2:0][lod_pkg::RECIPROCAL_W-1:0] reciprocal_near;
  logic [2:0][LIMIT_W-1:0] turned, limit_near, turned_near;
  logic                    ahead, ahead_near, valid_near, ready_near;
  logic [2:0]              reached;
  for (genvar k = 0; k < 3; k++) begin : g_near
    logic signed [CODE_W-1:0] low, high;
    logic signed [CEIL_W-1:0] from;
    // Two 17-bit numbers: 18 bits; not negative at most 32767 + 32768: 16 bits.
    logic [CEIL_W:0]          distance;
    assign {low, high, from} = {lo_q[k], hi_q[k], ceil_q[k]};
    assign distance   = (CEIL_W+1)'(low) - (CEIL_W+1)'(from);
    assign near[k]    = distance[CEIL_W] ? '0 : distance[NEAR_W-1:0];
    assign reached[k] = CEIL_W'(high) >= from;
    assign turned[k]  = cut_q[k] ? ~limit_q[k] : -limit_q[k];

    logic unused_bit;
    assign unused_bit = distance[NEAR_W];
  end
  assign ahead = reached == '1;
  pipe_stage #(.W(3 * (NEAR_W + lod_pkg::RECIPROCAL_W + 2 * LIMIT_W) + 1)) u_near (
    .clk_i, .rst_ni, .valid_i(valid_mirror), .ready_o(), .data_i({near, reciprocal_q, limit_q, turned, ahead}),
    .valid_o(valid_near), .ready_i(ready_near), .data_o({near_q, reciprocal_near, limit_near, turned_near, ahead_near})
  );
  logic           valid_last, ready_last;
  logic [T_W-1:0] entry;
  entry_distance u_entry (
    .clk_i, .rst_ni, .valid_i(valid_near), .ready_o(ready_near), .near_i(near_q), .reciprocal_i(reciprocal_near),
    .valid_o(valid_last), .ready_i(ready_last), .t_near_o(entry)
  );

  // Products and differences of the six pairs: pair k has the axes (k+1, k+2), pair k+3 the same turned.
  logic [5:0]                ready_low, valid_low, valid_high, ready_high;
  logic                      ready_product, valid_difference, ready_difference;
  logic [5:0][PRODUCT_W-1:0] difference, difference_q;
  for (genvar k = 0; k < 6; k++) begin : g_pair
    localparam int unsigned I = k < 3 ? (k + 1) % 3 : (k + 2) % 3;
    localparam int unsigned J = k < 3 ? (k + 2) % 3 : (k + 1) % 3;
    logic [PRODUCT_W-1:0] low, high;
    multiplier #(.A_W(CODE_W), .B_W(D_W + 1), .FACTOR_STAGES(FACTOR_STAGES), .PRODUCT_STAGES(PRODUCT_STAGES)) u_low (
      .clk_i, .rst_ni, .valid_i(valid_mirror), .ready_o(ready_low[k]), .a_i(lo_q[I]), .b_i({1'b0, d_q[J]}),
      .valid_o(valid_low[k]), .ready_i(ready_product), .product_o(low)
    );
    multiplier #(.A_W(CODE_W), .B_W(D_W + 1), .FACTOR_STAGES(FACTOR_STAGES), .PRODUCT_STAGES(PRODUCT_STAGES)) u_high (
      .clk_i, .rst_ni, .valid_i(valid_mirror), .ready_o(ready_high[k]), .a_i(hi_q[J]), .b_i({1'b0, d_q[I]}),
      .valid_o(valid_high[k]), .ready_i(ready_product), .product_o(high)
    );
    assign difference[k] = low - high;
  end
  assign ready_mirror = ready_low[0];
  pipe_stage #(.W(6 * PRODUCT_W)) u_difference (
    .clk_i, .rst_ni, .valid_i(valid_low[0]), .ready_o(ready_product), .data_i(difference),
    .valid_o(valid_difference), .ready_i(ready_difference), .data_o(difference_q)
  );

  // Against the limits.
  logic [2:0][LIMIT_W-1:0] limit_there, turned_there;
  logic                    ahead_there, slabs, slabs_last;
  logic                    valid_passes, ready_passes;
  logic [5:0]              passes;
  logic [6:0]              passes_q;
  pipe_delay #(.W(6 * LIMIT_W + 1), .STAGES(PRODUCT_LATENCY)) u_limits (
    .clk_i, .rst_ni, .valid_i(valid_near), .ready_o(), .data_i({limit_near, turned_near, ahead_near}),
    .valid_o(), .ready_i(ready_difference), .data_o({limit_there, turned_there, ahead_there})
  );
  for (genvar k = 0; k < 6; k++) begin : g_inside
    logic signed [PRODUCT_W-1:0] value;
    logic signed [LIMIT_W-1:0]   bound;
    assign value     = difference_q[k];
    assign bound     = k < 3 ? limit_there[k%3] : turned_there[k%3];
    assign passes[k] = value <= bound;
  end
  pipe_skid #(.W(7)) u_passes (
    .clk_i, .rst_ni, .valid_i(valid_difference), .ready_o(ready_difference), .data_i({ahead_there, passes}),
    .valid_o(valid_passes), .ready_i(ready_passes), .data_o(passes_q)
  );
  assign slabs = passes_q == '1;
  pipe_stage #(.W(1)) u_slabs (
    .clk_i, .rst_ni, .valid_i(valid_passes), .ready_o(ready_passes), .data_i(slabs),
    .valid_o(), .ready_i(ready_last), .data_o(slabs_last)
  );

  // Stage last: early termination. t_near 2^18 <= t_max iff t_near <= floor(t_max / 2^18).
  logic               hit;
  logic [T_W-1:0]     t_last, t_near;
  logic [TAG_W-1:0]   tag_last;
  pipe_delay #(.W(T_W + TAG_W), .STAGES(LATENCY - 1), .SKIDS(lod_pkg::BOX_TEST_SKIDS)) u_beside (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({in_i.t_max[lod_pkg::RAY_T_W-1:lod_pkg::T_NEAR_TO_T_SHIFT], tag_i}),
    .valid_o(), .ready_i(ready_last), .data_o({t_last, tag_last})
  );
  assign hit    = slabs_last && entry <= t_last;
  assign t_near = hit ? entry : '0;
  pipe_stage #(.W(1 + T_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_last), .ready_o(ready_last), .data_i({hit, t_near, tag_last}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

  // The box test takes less of a ray than `ray_setup` gives: the origin is in its moment.
  logic unused;
  assign unused = ^{in_i.ray.x.origin, in_i.ray.y.origin, in_i.ray.z.origin, in_i.t_max[lod_pkg::T_NEAR_TO_T_SHIFT-1:0],
                    in_i.ray.x.d, in_i.ray.y.d, in_i.ray.z.d, valid_low[5:1], ready_low[5:1], valid_high, ready_high};

endmodule

`default_nettype wire
