`default_nettype none

/// Elastic cross product of two signed vectors: cross_o = p x q = (p.y q.z - p.z q.y, p.z q.x - p.x q.z, p.x q.y - p.y q.x).
///
/// Vectors are {x, y, z}. Legal: components above -2^(W-1), so that each product is below 2^(2W-2) in magnitude and each difference of two fits 2 W
/// bits. Latency: lod_pkg::cross_product_latency(W), which is that of the multipliers with one factor stage and
/// lod_pkg::EDGE_PRODUCT_STAGES of products, and of the differences, a `pipe_skid`; interval 1.
module cross_product #(
  parameter int unsigned W = 33
) (
  input  logic           clk_i,
  input  logic           rst_ni,
  input  logic           valid_i,
  output logic           ready_o,
  input  logic [3*W-1:0] p_i,
  input  logic [3*W-1:0] q_i,
  output logic           valid_o,
  input  logic           ready_i,
  output logic [6*W-1:0] cross_o
);

  localparam int unsigned PRODUCT_W = 2 * W;

  // Component k is 2, 1, 0 for x, y, z, as they stand in a vector; the two that follow it in x, y, z, x are k - 1 and k - 2, modulo 3.
  logic [2:0]             valid_product, ready_product;
  logic                   valid_products, ready_products;
  logic [3*PRODUCT_W-1:0] minuends, subtrahends, differences;
  for (genvar k = 0; k < 3; k++) begin : g_component
    localparam int unsigned NEXT = (k + 2) % 3;
    localparam int unsigned LAST = (k + 1) % 3;
    multiplier #(.A_W(W), .B_W(W), .FACTOR_STAGES(1), .PRODUCT_STAGES(lod_pkg::EDGE_PRODUCT_STAGES)) u_minuend (
      .clk_i, .rst_ni, .valid_i, .ready_o(ready_product[k]), .a_i(p_i[NEXT*W +: W]), .b_i(q_i[LAST*W +: W]),
      .valid_o(valid_product[k]), .ready_i(ready_products), .product_o(minuends[k*PRODUCT_W +: PRODUCT_W])
    );
    multiplier #(.A_W(W), .B_W(W), .FACTOR_STAGES(1), .PRODUCT_STAGES(lod_pkg::EDGE_PRODUCT_STAGES)) u_subtrahend (
      .clk_i, .rst_ni, .valid_i, .ready_o(), .a_i(p_i[LAST*W +: W]), .b_i(q_i[NEXT*W +: W]),
      .valid_o(), .ready_i(ready_products), .product_o(subtrahends[k*PRODUCT_W +: PRODUCT_W])
    );
    assign differences[k*PRODUCT_W +: PRODUCT_W] = minuends[k*PRODUCT_W +: PRODUCT_W] - subtrahends[k*PRODUCT_W +: PRODUCT_W];
  end
  assign ready_o        = ready_product[0];
  assign valid_products = valid_product[0];

  logic unused_lockstep;
  assign unused_lockstep = ^{valid_product[2:1], ready_product[2:1]};

  pipe_skid #(.W(3 * PRODUCT_W)) u_difference (
    .clk_i, .rst_ni, .valid_i(valid_products), .ready_o(ready_products), .data_i(differences),
    .valid_o, .ready_i, .data_o(cross_o)
  );

endmodule

`default_nettype wire
