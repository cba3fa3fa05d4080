`default_nettype none

/// Per-ray constants of the box tests for a ray from an exact start. Twin of src/block/start_setup.rs.
///
/// The ray starts at X + f / 2^31. All is as ray_setup has it for X, but `moment` is that of the exact start, rounded down, and so is the ceiling exact. What the fraction adds to the moment, one difference of
/// two products an axis, is made beside ray_setup by a 32 x 31-bit multiplier of its own, in the same six cycles as the products there, and added behind both.
/// Legal: as in ray_setup, for X. Latency and interval are those of ray_setup: START_SETUP_LATENCY with lod_pkg::SETUP_BITS. It holds one item.
module start_setup #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned SETUP_BITS = lod_pkg::SETUP_BITS
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  input  logic                      valid_i,
  output logic                      ready_o,
  input  lod_pkg::start_setup_in_t  in_i,
  input  logic [TAG_W-1:0]          tag_i,
  output logic                      valid_o,
  input  logic                      ready_i,
  output lod_pkg::ray_setup_out_t   out_o,
  output logic [TAG_W-1:0]          tag_o
);

  localparam int unsigned F_W = lod_pkg::FRACTION_W;
  localparam int unsigned D_W = lod_pkg::DIRECTION_W / 3;
  localparam int unsigned PRODUCT_W = F_W + 1 + D_W;
  localparam int unsigned MOMENT_W = lod_pkg::MOMENT_W / 3;
  localparam int unsigned MORE_W = MOMENT_W - F_W;
  localparam int unsigned PRODUCTS = 6;
  if (lod_pkg::START_SETUP_LATENCY != lod_pkg::RAY_SETUP_LATENCY || lod_pkg::START_SETUP_INTERVAL != lod_pkg::RAY_SETUP_INTERVAL) begin : g_illegal_timing
    $error("start_setup: lod_pkg::START_SETUP_LATENCY and START_SETUP_INTERVAL must be those of ray_setup");
  end

  lod_pkg::ray_setup_in_t  whole_in;
  lod_pkg::ray_setup_out_t whole;
  assign whole_in = {in_i.start.point, in_i.direction};
  ray_setup #(.TAG_W(TAG_W), .SETUP_BITS(SETUP_BITS)) u_whole (
    .clk_i, .rst_ni, .valid_i, .ready_o, .in_i(whole_in), .tag_i, .valid_o, .ready_i, .out_o(whole), .tag_o
  );

  // Fraction and direction, x first; how many products were begun.
  logic [2:0][F_W-1:0] f_q;
  logic [2:0][D_W-1:0] d_q;
  logic [2:0]          count_q;
  logic                take;
  assign take = valid_i && ready_o;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) count_q <= 3'(PRODUCTS);
    else if (take) count_q <= '0;
    else if (count_q != 3'(PRODUCTS)) count_q <= count_q + 3'd1;
  end
  always_ff @(posedge clk_i) begin
    if (take) {f_q, d_q} <= {in_i.start.fraction, in_i.direction.z, in_i.direction.y, in_i.direction.x};
  end

  // Products f_y d_z, f_z d_y, f_z d_x, f_x d_z, f_x d_y, f_y d_x in cycles 0 to 5.
  logic [F_W-1:0]              factor_f;
  logic [D_W-1:0]              factor_d;
  logic signed [PRODUCT_W-1:0] product;
  logic                        valid_product, unused_ready;
  always_comb begin
    case (count_q)
      3'd0:    {factor_f, factor_d} = {f_q[1], d_q[2]};
      3'd1:    {factor_f, factor_d} = {f_q[2], d_q[1]};
      3'd2:    {factor_f, factor_d} = {f_q[2], d_q[0]};
      3'd3:    {factor_f, factor_d} = {f_q[0], d_q[2]};
      3'd4:    {factor_f, factor_d} = {f_q[0], d_q[1]};
      default: {factor_f, factor_d} = {f_q[1], d_q[0]};
    endcase
  end
  multiplier #(.A_W(F_W + 1), .B_W(D_W), .FACTOR_STAGES(1)) u_product (
    .clk_i, .rst_ni, .valid_i(count_q != 3'(PRODUCTS)), .ready_o(unused_ready), .a_i({1'b0, factor_f}), .b_i(factor_d),
    .valid_o(valid_product), .ready_i(1'b1), .product_o(product)
  );

  // Each product below 2^61, the difference of two below 2^62; it changes its sign where one of its axes is mirrored. What is below whole numbers is dropped: a floor.
  logic                       second_q, turned;
  logic [MOMENT_W-2:0]        minuend_q;
  logic [1:0]                 axis_q;
  logic [2:0]                 mirror;
  logic [MOMENT_W-1:0]        minuend, subtrahend, difference;
  logic [2:0][MORE_W-1:0]     more_q;
  assign mirror     = {d_q[2][D_W-1], d_q[1][D_W-1], d_q[0][D_W-1]};
  assign turned     = axis_q == 2'd0 ? mirror[1] != mirror[2] : axis_q == 2'd1 ? mirror[2] != mirror[0] : mirror[0] != mirror[1];
  assign minuend    = turned ? MOMENT_W'(product) : MOMENT_W'($signed(minuend_q));
  assign subtrahend = turned ? MOMENT_W'($signed(minuend_q)) : MOMENT_W'(product);
  assign difference = minuend - subtrahend;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) second_q <= 1'b0;
    else if (valid_product) second_q <= !second_q;
  end
  always_ff @(posedge clk_i) begin
    if (take) axis_q <= '0;
    else if (valid_product && second_q) axis_q <= axis_q + 2'd1;
    if (valid_product) begin
      minuend_q <= product[MOMENT_W-2:0];
      if (second_q) more_q <= {difference[MOMENT_W-1:F_W], more_q[2:1]};
    end
  end

  logic [F_W-1:0] unused_below;
  assign unused_below = difference[F_W-1:0];

  // The exact moment, and ceilings: that of a whole point with a fraction ahead of it is that of the next one.
  logic [2:0][MOMENT_W-1:0]        whole_moment, moment;
  logic [2:0][lod_pkg::AXIS_W-1:0] whole_axis, axes;
  assign whole_moment = {whole.moment.z, whole.moment.y, whole.moment.x};
  assign whole_axis   = {whole.z, whole.y, whole.x};
  for (genvar k = 0; k < 3; k++) begin : g_axis
    lod_pkg::axis_t           of_whole;
    logic signed [MORE_W-1:0] more;
    logic [16:0]              ceil;
    assign of_whole  = whole_axis[k];
    assign more      = more_q[k];
    assign moment[k] = whole_moment[k] + MOMENT_W'(more);
    assign ceil      = of_whole.ceil + 17'(!of_whole.mirror && f_q[k] != '0 && of_whole.origin[lod_pkg::BOX_SHIFT-1:0] == '0);
    assign axes[k]   = {of_whole.mirror, of_whole.d, of_whole.origin, ceil, of_whole.reciprocal};
  end
  assign out_o = {axes[0], axes[1], axes[2], moment[0], moment[1], moment[2]};

endmodule

`default_nettype wire
