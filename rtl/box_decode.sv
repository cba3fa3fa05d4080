`default_nettype none

/// A box in the frame of a quad-BVH node as one of 16-bit codes: for units that keep boxes of both kinds. Twin of src/block/box_decode.rs.
///
/// One `framed_box`. Legal: origin >= -32767. Latency BOX_DECODE_LATENCY = 2; interval 1.
module box_decode #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::box_decode_in_t  in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::box_decode_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  if (lod_pkg::BOX_DECODE_LATENCY != 2) begin : g_illegal_latency
    $error("box_decode: lod_pkg::BOX_DECODE_LATENCY must be 2");
  end

  framed_box #(.PLANE_W(5), .TAG_W(TAG_W)) u_box (
    .clk_i, .rst_ni, .valid_i, .ready_o, .origin_i(in_i.origin), .halves_i(in_i.halves), .exponents_i(in_i.exponents),
    .planes_i({in_i.lo[0], in_i.lo[1], in_i.lo[2], in_i.hi[0], in_i.hi[1], in_i.hi[2]}), .tag_i,
    .valid_o, .ready_i, .bounds_o(out_o.bounds), .tag_o
  );

endmodule

`default_nettype wire
