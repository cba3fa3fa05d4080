`default_nettype none

/// Per-ray constants of the box tests. Twin of src/block/ray_setup.rs.
///
/// Axes are mirrored so that d >= 0. `moment` holds x_i d_j - x_j d_i for yz, zx, xy; `ceil` = ceil(x / 2^16); mantissa / 2^shift = 2^30 / d rounded down. With e the
/// place of d's highest bit and n = d 2^(29-e): mantissa = floor(2^47 / n) and shift = e - 12, from the 18 bits of a restoring division, SETUP_BITS in a step; if
/// d = 2^e they are 2^17 and e - 13; below e = 13 what does not fit is held at 2^18 - 1 and 0; d = 0 gives 0 and 0.
/// Legal: |x| < 2^31, |d_i| < 2^30, SETUP_BITS 1 to 3. Latency and interval are constant: 22, 14 or 11; it holds one item. One 32 x 31-bit multiplier serves the
/// six products, which take as long as the division of three bits a step. With lod_pkg::SETUP_BITS they are RAY_SETUP_LATENCY.
module ray_setup #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned SETUP_BITS = lod_pkg::SETUP_BITS
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  lod_pkg::ray_setup_in_t  in_i,
  input  logic [TAG_W-1:0]        tag_i,
  output logic                    valid_o,
  input  logic                    ready_i,
  output lod_pkg::ray_setup_out_t out_o,
  output logic [TAG_W-1:0]        tag_o
);

  localparam int unsigned X_W = lod_pkg::POINT_W / 3;
  localparam int unsigned D_W = 30;
  localparam int unsigned MANTISSA_W = 18;
  localparam int unsigned SHIFT_W = 5;
  localparam int unsigned CEIL_W = 17;
  localparam int unsigned MOMENT_W = lod_pkg::MOMENT_W / 3;
  localparam int unsigned PRODUCT_W = X_W + D_W + 1;
  // Choosing the factors takes a cycle of its own.
  localparam int unsigned FACTOR_STAGES = 1;
  localparam int unsigned PRODUCT_LATENCY = FACTOR_STAGES + lod_pkg::multiplier_latency(X_W, D_W + 1);
  localparam int unsigned PRODUCTS = 6;
  // Cycle 0 finds the highest bit, cycle 1 normalises, a further one makes multiples where steps take some, then the steps, and one cycle to choose.
  localparam int unsigned ODDS = 2**(SETUP_BITS-1);
  localparam int unsigned MULTIPLE_W = D_W + SETUP_BITS;
  localparam int unsigned STEPS = MANTISSA_W / SETUP_BITS;
  localparam int unsigned FIRST_STEP = ODDS == 1 ? 2 : 3;
  localparam int unsigned CHOICE = FIRST_STEP + STEPS;
  localparam int unsigned LAST = CHOICE + 1;
  localparam int unsigned COUNT_W = $clog2(LAST + 1);
  if (STEPS * SETUP_BITS != MANTISSA_W) begin : g_illegal_bits
    $error("ray_setup: steps of %0d bits do not make %0d", SETUP_BITS, MANTISSA_W);
  end
  if (SETUP_BITS == lod_pkg::SETUP_BITS && (lod_pkg::RAY_SETUP_LATENCY != LAST + 1 || lod_pkg::RAY_SETUP_INTERVAL != LAST + 1)) begin : g_illegal_timing
    $error("ray_setup: lod_pkg::RAY_SETUP_LATENCY and RAY_SETUP_INTERVAL must be %0d", LAST + 1);
  end
  if (PRODUCTS + PRODUCT_LATENCY > LAST) begin : g_illegal_products
    $error("ray_setup: the products take longer than the division");
  end

  // One item: `count_q` tells how far it is.
  logic               busy_q, take;
  logic [COUNT_W-1:0] count_q;
  assign valid_o = busy_q && count_q == COUNT_W'(LAST);
  assign ready_o = !busy_q || (valid_o && ready_i);
  assign take    = valid_i && ready_o;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      busy_q  <= 1'b0;
      count_q <= '0;
    end else if (ready_o) begin
      busy_q  <= valid_i;
      count_q <= '0;
    end else if (!valid_o) count_q <= count_q + COUNT_W'(1);
  end

  logic [TAG_W-1:0] tag_q;
  assign tag_o = tag_q;
  always_ff @(posedge clk_i) begin
    if (take) tag_q <= tag_i;
  end

  // Axes, x first.
  logic [2:0][X_W-1:0] x, x_q;
  logic [2:0][D_W:0]   d;
  logic [2:0][D_W-1:0] d_q;
  logic [2:0]          mirror_q;
  logic [2:0][lod_pkg::AXIS_W-1:0] axis;
  assign x = {in_i.origin.z, in_i.origin.y, in_i.origin.x};
  assign d = {in_i.direction.z, in_i.direction.y, in_i.direction.x};

  for (genvar k = 0; k < 3; k++) begin : g_axis
    // |d| < 2^30 and |x| < 2^31: both magnitudes keep their width.
    always_ff @(posedge clk_i) begin
      if (take) begin
        mirror_q[k] <= d[k][D_W];
        d_q[k]      <= d[k][D_W] ? -d[k][D_W-1:0] : d[k][D_W-1:0];
        x_q[k]      <= d[k][D_W] ? -x[k] : x[k];
      end
    end

    // Place of the highest bit; 0 for d = 0.
    logic [SHIFT_W-1:0] place, place_q;
    always_comb begin
      place = '0;
      for (int unsigned b = 0; b < D_W; b++) begin
        if (d_q[k][b]) place = SHIFT_W'(b);
      end
    end

    // Normalised divisor, highest bit set; the division starts from half its range, which is below it unless d is a power of two.
    logic [D_W-1:0]             divisor_q, remainder_q, remainder;
    logic [ODDS*MULTIPLE_W-1:0] made, odd;
    logic [MANTISSA_W-1:0]      quotient_q;
    logic [SETUP_BITS-1:0]      digit;
    logic                       power;
    assign power = divisor_q[D_W-2:0] == '0;
    divide_multiples #(.W(D_W), .BITS(SETUP_BITS)) u_multiples (.divisor_i(divisor_q), .odd_o(made));
    if (ODDS == 1) begin : g_divisor
      assign odd = made;
    end else begin : g_multiples
      logic [(ODDS-1)*MULTIPLE_W-1:0] higher_q;
      always_ff @(posedge clk_i) begin
        if (count_q == COUNT_W'(2)) higher_q <= made[ODDS*MULTIPLE_W-1:MULTIPLE_W];
      end
      assign odd = {higher_q, made[MULTIPLE_W-1:0]};
    end
    divide_step #(.W(D_W), .BITS(SETUP_BITS)) u_step (
      .remainder_i(remainder_q), .odd_i(odd), .quotient_o(digit), .remainder_o(remainder)
    );
    always_ff @(posedge clk_i) begin
      if (count_q == COUNT_W'(0)) place_q <= place;
      if (count_q == COUNT_W'(1)) begin
        divisor_q   <= d_q[k] << (SHIFT_W'(D_W - 1) - place_q);
        remainder_q <= {1'b1, {(D_W-1){1'b0}}};
      end else if (count_q >= COUNT_W'(FIRST_STEP) && count_q < COUNT_W'(CHOICE)) begin
        remainder_q <= remainder;
        quotient_q  <= {quotient_q[MANTISSA_W-SETUP_BITS-1:0], digit};
      end
    end

    logic [MANTISSA_W-1:0] mantissa, mantissa_q;
    logic [SHIFT_W-1:0]    shift, shift_q;
    always_comb begin
      if (d_q[k] == '0) {mantissa, shift} = '0;
      else if (place_q < SHIFT_W'(12) || (place_q == SHIFT_W'(12) && power)) {mantissa, shift} = {{MANTISSA_W{1'b1}}, SHIFT_W'(0)};
      else if (power) {mantissa, shift} = {1'b1, {(MANTISSA_W-1){1'b0}}, place_q - SHIFT_W'(13)};
      else {mantissa, shift} = {quotient_q, place_q - SHIFT_W'(12)};
    end
    always_ff @(posedge clk_i) begin
      if (count_q == COUNT_W'(CHOICE)) {mantissa_q, shift_q} <= {mantissa, shift};
    end

    // ceil(x / 2^16): 32 bits over 2^16, plus 1 if anything was cut off: 17 bits.
    logic signed [X_W-lod_pkg::BOX_SHIFT-1:0] code;
    logic [CEIL_W-1:0]                        ceil_q;
    assign code = x_q[k][X_W-1:lod_pkg::BOX_SHIFT];
    always_ff @(posedge clk_i) begin
      if (count_q == COUNT_W'(0)) ceil_q <= CEIL_W'(code) + CEIL_W'(x_q[k][lod_pkg::BOX_SHIFT-1:0] != '0);
    end
    assign axis[k] = {mirror_q[k], d_q[k], x_q[k], ceil_q, mantissa_q, shift_q};
  end

  // Products x_y d_z, x_z d_y, x_z d_x, x_x d_z, x_x d_y, x_y d_x in cycles 0 to 5.
  logic [X_W-1:0]       factor_x;
  logic [D_W-1:0]       factor_d;
  logic [PRODUCT_W-1:0] product, minuend_q;
  logic                 valid_product, unused_ready, unused_bit;
  always_comb begin
    case (count_q)
      COUNT_W'(0): {factor_x, factor_d} = {x_q[1], d_q[2]};
      COUNT_W'(1): {factor_x, factor_d} = {x_q[2], d_q[1]};
      COUNT_W'(2): {factor_x, factor_d} = {x_q[2], d_q[0]};
      COUNT_W'(3): {factor_x, factor_d} = {x_q[0], d_q[2]};
      COUNT_W'(4): {factor_x, factor_d} = {x_q[0], d_q[1]};
      default:     {factor_x, factor_d} = {x_q[1], d_q[0]};
    endcase
  end
  multiplier #(.A_W(X_W), .B_W(D_W + 1), .FACTOR_STAGES(FACTOR_STAGES)) u_product (
    .clk_i, .rst_ni, .valid_i(busy_q && count_q < COUNT_W'(PRODUCTS)), .ready_o(unused_ready), .a_i(factor_x), .b_i({1'b0, factor_d}),
    .valid_o(valid_product), .ready_i(1'b1), .product_o(product)
  );

  // Each product below 2^61, the difference of two below 2^62.
  logic                     second_q;
  logic [2:0][MOMENT_W-1:0] moment_q;
  assign unused_bit = product[PRODUCT_W-1] ^ minuend_q[PRODUCT_W-1];
  always_ff @(posedge clk_i) begin
    if (!rst_ni) second_q <= 1'b0;
    else if (valid_product) second_q <= !second_q;
  end
  always_ff @(posedge clk_i) begin
    if (valid_product) begin
      minuend_q <= product;
      if (second_q) moment_q <= {minuend_q[MOMENT_W-1:0] - product[MOMENT_W-1:0], moment_q[2:1]};
    end
  end

  assign out_o = {axis[0], axis[1], axis[2], moment_q[0], moment_q[1], moment_q[2]};

endmodule

`default_nettype wire
