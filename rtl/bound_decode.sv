`default_nettype none

/// Displacement bound from its 10-bit code. Twin of src/block/bound_decode.rs (paper section 4.3).
///
/// h = floor(code^2 mantissa / 2^shift) units. Monotone in the code; code 0 gives 0.
/// Legal: any code; scales for which h is below 2^33. Latency BOUND_DECODE_LATENCY; interval 1.
module bound_decode #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic                       valid_i,
  output logic                       ready_o,
  input  lod_pkg::bound_decode_in_t  in_i,
  input  logic [TAG_W-1:0]           tag_i,
  output logic                       valid_o,
  input  logic                       ready_i,
  output lod_pkg::bound_decode_out_t out_o,
  output logic [TAG_W-1:0]           tag_o
);

  localparam int unsigned H_W = lod_pkg::BOUND_W;
  localparam int unsigned CODE_W = lod_pkg::BOUND_CODE_W;
  localparam int unsigned SQUARE_W = 2 * CODE_W;
  localparam int unsigned MANTISSA_W = 18;
  localparam int unsigned SHIFT_W = 6;
  // 20 bits of square times 18 of mantissa. Both are unsigned: one bit more as signed numbers.
  localparam int unsigned PRODUCT_W = SQUARE_W + MANTISSA_W;
  localparam int unsigned PRODUCT_LATENCY = lod_pkg::multiplier_latency(SQUARE_W + 1, MANTISSA_W + 1);
  if (lod_pkg::BOUND_DECODE_LATENCY != 1 + PRODUCT_LATENCY + 2) begin : g_illegal_latency
    $error("bound_decode: lod_pkg::BOUND_DECODE_LATENCY must be %0d", 1 + PRODUCT_LATENCY + 2);
  end

  logic                  valid_square, ready_square;
  logic [SQUARE_W-1:0]   square, square_q;
  logic [MANTISSA_W-1:0] mantissa_q;
  logic [SHIFT_W-1:0]    shift_square;
  logic [TAG_W-1:0]      tag_square;
  assign square = SQUARE_W'(in_i.code) * SQUARE_W'(in_i.code);
  pipe_stage #(.W(SQUARE_W + lod_pkg::BOUND_SCALE_W + TAG_W)) u_square (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({square, in_i.scale, tag_i}),
    .valid_o(valid_square), .ready_i(ready_square), .data_o({square_q, mantissa_q, shift_square, tag_square})
  );

  logic                 valid_product, ready_product;
  logic [PRODUCT_W+1:0] product;
  multiplier #(.A_W(SQUARE_W + 1), .B_W(MANTISSA_W + 1)) u_product (
    .clk_i, .rst_ni, .valid_i(valid_square), .ready_o(ready_square), .a_i({1'b0, square_q}), .b_i({1'b0, mantissa_q}),
    .valid_o(valid_product), .ready_i(ready_product), .product_o(product)
  );
  logic [SHIFT_W-1:0] shift_product;
  logic [TAG_W-1:0]   tag_product;
  pipe_delay #(.W(SHIFT_W + TAG_W), .STAGES(PRODUCT_LATENCY)) u_beside (
    .clk_i, .rst_ni, .valid_i(valid_square), .ready_o(), .data_i({shift_square, tag_square}),
    .valid_o(), .ready_i(ready_product), .data_o({shift_product, tag_product})
  );

  // The shift, coarse then fine.
  logic                 valid_coarse, ready_coarse;
  logic [PRODUCT_W-1:0] coarse, coarse_q, fine;
  logic [2:0]           shift_fine;
  logic [TAG_W-1:0]     tag_coarse;
  assign coarse = product[PRODUCT_W-1:0] >> {shift_product[5:3], 3'd0};
  pipe_stage #(.W(PRODUCT_W + 3 + TAG_W)) u_coarse (
    .clk_i, .rst_ni, .valid_i(valid_product), .ready_o(ready_product), .data_i({coarse, shift_product[2:0], tag_product}),
    .valid_o(valid_coarse), .ready_i(ready_coarse), .data_o({coarse_q, shift_fine, tag_coarse})
  );
  assign fine = coarse_q >> shift_fine;
  pipe_stage #(.W(H_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_coarse), .ready_o(ready_coarse), .data_i({fine[H_W-1:0], tag_coarse}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

  // Legal scales keep h below 2^33.
  logic unused_upper;
  assign unused_upper = ^{product[PRODUCT_W+1:PRODUCT_W], fine[PRODUCT_W-1:H_W]};

endmodule

`default_nettype wire
