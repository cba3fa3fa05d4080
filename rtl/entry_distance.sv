`default_nettype none

/// The t_near of a box: the largest of the three axes' entry distances (docs/numbers.md, "Box test").
///
/// Per axis floor(near mantissa / 2^shift), in steps of 2^16 units, held at 2^17 - 1; near is the distance to the box's near side, 0 if the side is behind.
/// `mantissa` / 2^`shift` is the reciprocal of the direction, rounded down. Legal: any. Its last register but one is a
/// `pipe_skid`. Latency ENTRY_DISTANCE_LATENCY; interval 1.
module entry_distance (
  input  logic                                  clk_i,
  input  logic                                  rst_ni,
  input  logic                                  valid_i,
  output logic                                  ready_o,
  input  logic [2:0][15:0]                      near_i,
  input  logic [2:0][lod_pkg::RECIPROCAL_W-1:0] reciprocal_i,
  output logic                                  valid_o,
  input  logic                                  ready_i,
  output logic [lod_pkg::T_NEAR_W-1:0]          t_near_o
);

  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  // A near side ahead: lo - ceil of two box codes, at most 2^16 - 1.
  localparam int unsigned NEAR_W = 16;
  localparam int unsigned MANTISSA_W = 18;
  localparam int unsigned SHIFT_W = 5;
  // Both unsigned, so that one 18 x 18 multiplier of the FPGA does it; as signed numbers the mantissa would need two.
  localparam int unsigned PRODUCT_W = NEAR_W + MANTISSA_W;
  if (lod_pkg::ENTRY_DISTANCE_LATENCY != 5) begin : g_illegal_latency
    $error("entry_distance: lod_pkg::ENTRY_DISTANCE_LATENCY must be 5");
  end

  // Stage 1: the factors. Stage 2: the products. Stage 3: shifted and held.
  logic [2:0][NEAR_W-1:0]                near_q;
  logic [2:0][lod_pkg::RECIPROCAL_W-1:0] reciprocal_q;
  logic [2:0][PRODUCT_W-1:0]             product, product_q;
  logic [2:0][SHIFT_W-1:0]               shift, shift_q;
  logic [2:0][T_W-1:0]                   held, held_q;
  logic                                  valid_factors, ready_factors, valid_product, ready_shift;
  pipe_stage #(.W(3 * (NEAR_W + lod_pkg::RECIPROCAL_W))) u_factors (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({near_i, reciprocal_i}),
    .valid_o(valid_factors), .ready_i(ready_factors), .data_o({near_q, reciprocal_q})
  );
  for (genvar k = 0; k < 3; k++) begin : g_axis
    logic [MANTISSA_W-1:0] mantissa;
    logic [PRODUCT_W-1:0]  shifted;
    assign {mantissa, shift[k]} = reciprocal_q[k];
    assign product[k] = PRODUCT_W'(near_q[k]) * PRODUCT_W'(mantissa);
    assign shifted    = product_q[k] >> shift_q[k];
    assign held[k]    = shifted[PRODUCT_W-1:T_W] != '0 ? '1 : shifted[T_W-1:0];
  end
  pipe_stage #(.W(3 * (PRODUCT_W + SHIFT_W))) u_product (
    .clk_i, .rst_ni, .valid_i(valid_factors), .ready_o(ready_factors), .data_i({product, shift}),
    .valid_o(valid_product), .ready_i(ready_shift), .data_o({product_q, shift_q})
  );

  logic valid_shift, ready_pair;
  pipe_stage #(.W(3 * T_W)) u_shift (
    .clk_i, .rst_ni, .valid_i(valid_product), .ready_o(ready_shift), .data_i(held),
    .valid_o(valid_shift), .ready_i(ready_pair), .data_o(held_q)
  );

  logic           valid_pair, ready_last;
  logic [T_W-1:0] pair, pair_q, third_q, largest;
  assign pair = held_q[0] > held_q[1] ? held_q[0] : held_q[1];
  pipe_skid #(.W(2 * T_W)) u_pair (
    .clk_i, .rst_ni, .valid_i(valid_shift), .ready_o(ready_pair), .data_i({pair, held_q[2]}),
    .valid_o(valid_pair), .ready_i(ready_last), .data_o({pair_q, third_q})
  );
  assign largest = pair_q > third_q ? pair_q : third_q;
  pipe_stage #(.W(T_W)) u_last (
    .clk_i, .rst_ni, .valid_i(valid_pair), .ready_o(ready_last), .data_i(largest), .valid_o, .ready_i, .data_o(t_near_o)
  );

endmodule

`default_nettype wire
