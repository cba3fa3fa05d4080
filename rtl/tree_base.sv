`default_nettype none

/// Where a tree's vertex lines and sibling groups begin. Twin of src/block/tree_base.rs.
///
/// With V = (4^N - 1) / 3 = binary 0101..01 of N ones and G = (V - 1) / 4 (0 if N = 0): vertices + tree V, or vertices + 2 tree G if they are compact, and
/// bounds + tree G. So one product serves all: tree G = (tree V - tree) / 4, and 0 if N = 0, where tree V is 0.
/// Legal: levels <= MAX_LEVELS; both results below 2^36, which the size of the sections keeps. Latency TREE_BASE_LATENCY; interval 1.
module tree_base #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  lod_pkg::tree_base_in_t  in_i,
  input  logic [TAG_W-1:0]        tag_i,
  output logic                    valid_o,
  input  logic                    ready_i,
  output lod_pkg::tree_base_out_t out_o,
  output logic [TAG_W-1:0]        tag_o
);

  localparam int unsigned ADDRESS_W = lod_pkg::LINE_ADDRESS_W;
  localparam int unsigned TREE_W = 28;
  // Both factors are unsigned: one bit more as signed numbers.
  localparam int unsigned LINES_W = lod_pkg::TREE_LINES_W;
  localparam int unsigned PRODUCT_W = TREE_W + LINES_W;
  // Legal results fit an address, so the upper bits of a wider product are 0.
  localparam int unsigned OFFSET_W = PRODUCT_W < ADDRESS_W ? PRODUCT_W : ADDRESS_W;
  localparam int unsigned PRODUCT_LATENCY = lod_pkg::multiplier_latency(TREE_W + 1, LINES_W + 1);
  if (lod_pkg::TREE_BASE_LATENCY != PRODUCT_LATENCY + 2) begin : g_illegal_latency
    $error("tree_base: lod_pkg::TREE_BASE_LATENCY must be %0d", PRODUCT_LATENCY + 2);
  end

  logic [LINES_W-1:0] lines;
  always_comb begin
    lines = '0;
    for (int unsigned k = 0; k < lod_pkg::MAX_LEVELS; k++) lines[2*k] = in_i.levels > 4'(k);
  end

  logic                 valid_product, ready_product;
  logic [PRODUCT_W+1:0] product;
  multiplier #(.A_W(TREE_W + 1), .B_W(LINES_W + 1)) u_product (
    .clk_i, .rst_ni, .valid_i, .ready_o, .a_i({1'b0, in_i.tree}), .b_i({1'b0, lines}),
    .valid_o(valid_product), .ready_i(ready_product), .product_o(product)
  );
  logic [TREE_W-1:0]    tree_q;
  logic [ADDRESS_W-1:0] vertices_q, bounds_q;
  logic [TAG_W-1:0]     tag_q;
  logic                 compact_q, split_q;
  pipe_delay #(.W(2 + TREE_W + 2 * ADDRESS_W + TAG_W), .STAGES(PRODUCT_LATENCY)) u_beside (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i({in_i.compact, in_i.levels != '0, in_i.tree, in_i.vertices, in_i.bounds, tag_i}),
    .valid_o(), .ready_i(ready_product), .data_o({compact_q, split_q, tree_q, vertices_q, bounds_q, tag_q})
  );

  // The difference is a multiple of 4.
  logic [PRODUCT_W-1:0] groups, lines_before;
  assign groups       = split_q ? (product[PRODUCT_W-1:0] - PRODUCT_W'(tree_q)) >> 2 : '0;
  assign lines_before = compact_q ? groups << 1 : product[PRODUCT_W-1:0];
  logic unused_sign;
  assign unused_sign = ^product[PRODUCT_W+1:PRODUCT_W];
  if (PRODUCT_W > OFFSET_W) begin : g_room
    logic unused_upper;
    assign unused_upper = ^{lines_before[PRODUCT_W-1:OFFSET_W], groups[PRODUCT_W-1:OFFSET_W]};
  end

  logic                 valid_offset, ready_offset;
  logic [OFFSET_W-1:0]  vertices_offset, bounds_offset;
  logic [ADDRESS_W-1:0] vertices_base, bounds_base;
  logic [TAG_W-1:0]     tag_offset;
  pipe_stage #(.W(2 * OFFSET_W + 2 * ADDRESS_W + TAG_W)) u_offset (
    .clk_i, .rst_ni, .valid_i(valid_product), .ready_o(ready_product),
    .data_i({lines_before[OFFSET_W-1:0], groups[OFFSET_W-1:0], vertices_q, bounds_q, tag_q}),
    .valid_o(valid_offset), .ready_i(ready_offset),
    .data_o({vertices_offset, bounds_offset, vertices_base, bounds_base, tag_offset})
  );

  logic [ADDRESS_W-1:0] vertices, bounds;
  assign vertices = vertices_base + ADDRESS_W'(vertices_offset);
  assign bounds   = bounds_base + ADDRESS_W'(bounds_offset);
  pipe_stage #(.W(2 * ADDRESS_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_offset), .ready_o(ready_offset), .data_i({vertices, bounds, tag_offset}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
