/// The t_near of a box: the largest of the three axes' entry distances (docs/numbers.md, "Box test").
///
/// Per axis floor(near mantissa / 2^shift), in steps of 2^16 units, held at 2^17 - 1; near is the distance to the box's near side, 0 if the side is behind.
/// `mantissa` / 2^`shift` is the reciprocal of the direction, rounded down. Legal: any. Latency ENTRY_DISTANCE_LATENCY; interval 1.
module entry_distance (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  logic                             valid_i,
  output logic                             ready_o,
  input  logic [2:0][15:0]                 near_i,
  input  logic [2:0][lod_pkg::RECIPROCAL_W-1:0] reciprocal_i,
  output logic                             valid_o,
  input  logic                             ready_i,
  output logic [lod_pkg::T_NEAR_W-1:0]     t_near_o
);

  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  // A near side ahead: lo - ceil of two box codes, at most 2^16 - 1. Both factors are unsigned: one bit more as signed numbers.
  localparam int unsigned NEAR_W = 16;
  localparam int unsigned MANTISSA_W = 18;
  localparam int unsigned SHIFT_W = 5;
  localparam int unsigned PRODUCT_W = NEAR_W + MANTISSA_W;
  localparam int unsigned PRODUCT_LATENCY = lod_pkg::multiplier_latency(NEAR_W + 1, MANTISSA_W + 1);
  if (lod_pkg::ENTRY_DISTANCE_LATENCY != PRODUCT_LATENCY + 3) begin : g_illegal_latency
    $error("entry_distance: lod_pkg::ENTRY_DISTANCE_LATENCY must be %0d", PRODUCT_LATENCY + 3);
  end

  logic [2:0]          valid_product, ready_product;
  logic                ready_shift;
  logic [2:0][T_W-1:0] held, held_q;
  for (genvar k = 0; k < 3; k++) begin : g_axis
    logic [MANTISSA_W-1:0] mantissa;
    logic [SHIFT_W-1:0]    shift, shift_q;
    logic [PRODUCT_W+1:0]  product;
    logic [PRODUCT_W-1:0]  shifted;
    logic [1:0]            unused_sign;
    assign {mantissa, shift} = reciprocal_i[k];
    multiplier #(.A_W(NEAR_W + 1), .B_W(MANTISSA_W + 1)) u_product (
      .clk_i, .rst_ni, .valid_i, .ready_o(ready_product[k]), .a_i({1'b0, near_i[k]}), .b_i({1'b0, mantissa}),
      .valid_o(valid_product[k]), .ready_i(ready_shift), .product_o(product)
    );
    pipe_delay #(.W(SHIFT_W), .STAGES(PRODUCT_LATENCY)) u_shift_beside (
      .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(shift), .valid_o(), .ready_i(ready_shift), .data_o(shift_q)
    );
    assign shifted     = product[PRODUCT_W-1:0] >> shift_q;
    assign held[k]     = shifted[PRODUCT_W-1:T_W] != '0 ? '1 : shifted[T_W-1:0];
    assign unused_sign = product[PRODUCT_W+1:PRODUCT_W];
  end
  assign ready_o = ready_product[0];

  logic valid_shift, ready_pair;
  pipe_stage #(.W(3 * T_W)) u_shift (
    .clk_i, .rst_ni, .valid_i(valid_product[0]), .ready_o(ready_shift), .data_i(held),
    .valid_o(valid_shift), .ready_i(ready_pair), .data_o(held_q)
  );

  logic           valid_pair, ready_last;
  logic [T_W-1:0] pair, pair_q, third_q, largest;
  assign pair = held_q[0] > held_q[1] ? held_q[0] : held_q[1];
  pipe_stage #(.W(2 * T_W)) u_pair (
    .clk_i, .rst_ni, .valid_i(valid_shift), .ready_o(ready_pair), .data_i({pair, held_q[2]}),
    .valid_o(valid_pair), .ready_i(ready_last), .data_o({pair_q, third_q})
  );
  assign largest = pair_q > third_q ? pair_q : third_q;
  pipe_stage #(.W(T_W)) u_last (
    .clk_i, .rst_ni, .valid_i(valid_pair), .ready_o(ready_last), .data_i(largest), .valid_o, .ready_i, .data_o(t_near_o)
  );

  logic unused_lockstep;
  assign unused_lockstep = ^{valid_product[2:1], ready_product[2:1]};

endmodule
