`default_nettype none

/// Inserted vertices of a node's triangle: at full resolution, and morphed for this ray between the midpoints of its morphed edges and there. Twin of
/// src/block/tessellate.rs (paper section 3.4).
///
/// Three `morph_vertex` in lockstep: vertex i lies on the edge between the two corners that are not p_i, and opens by s_i. A displacement counts steps of 2^e
/// units, e = max(grid + padding, floor(k / 16) - 11) with k = code + offset of its edge.
/// Legal: corners multiples of 2^(grid+1), vertices of 2^grid, grid 0 to 15, |v| <= 0x7FFE_0000, s 0 to 256; displacements of 13 bits, e at most 21.
/// Latency TESSELLATE_LATENCY; interval 1.
module tessellate #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::tessellate_in_t  in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::tessellate_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  localparam int unsigned P_W = lod_pkg::KEPT_POINT_W;
  // 8 and 9 bits added; the fraction of an octave.
  localparam int unsigned K_W = lod_pkg::BOUND_SCALE_W + 1;
  localparam int unsigned PART_W = 4;
  localparam int unsigned OCTAVE_W = K_W - PART_W;
  localparam int unsigned SHIFT_W = 5;

  // Per vertex: the ends of its edge at full resolution and as morphed, what is stored of it, its code and its state.
  logic [2:0][P_W-1:0]                   fa, fb, pa, pb, full, morphed;
  logic [2:0][lod_pkg::POINT_W-1:0]      v;
  logic [2:0][lod_pkg::BOUND_CODE_W-1:0] code;
  logic [2:0][lod_pkg::EDGE_STATE_W-1:0] s;
  logic [2:0]                            valid, ready;
  logic [2:0][P_W-1:0] f, p;
  assign f    = {lod_pkg::keep_point(in_i.f2), lod_pkg::keep_point(in_i.f1), lod_pkg::keep_point(in_i.f0)};
  assign p    = {lod_pkg::keep_point(in_i.p2), lod_pkg::keep_point(in_i.p1), lod_pkg::keep_point(in_i.p0)};
  assign fa   = {f[0], f[2], f[1]};
  assign fb   = {f[1], f[0], f[2]};
  assign pa   = {p[0], p[2], p[1]};
  assign pb   = {p[1], p[0], p[2]};
  assign v    = {in_i.v2, in_i.v1, in_i.v0};
  assign code = {in_i.e2, in_i.e1, in_i.e0};
  assign s    = {in_i.s2, in_i.s1, in_i.s0};

  // Of the two forms of vertices this hardware may have one.
  logic compact;
  assign compact = lod_pkg::EXACT_VERTICES == 0 || (lod_pkg::COMPACT_VERTICES != 0 && in_i.compact);

  // Zero bits of the vertices as stored.
  logic [SHIFT_W-1:0] zeros;
  assign zeros = SHIFT_W'(in_i.grid) + SHIFT_W'(in_i.padding);

  for (genvar i = 0; i < 3; i++) begin : g_vertex
    logic [K_W-1:0]      k;
    logic [OCTAVE_W-1:0] octave;
    logic [SHIFT_W-1:0]  shift;
    logic                unused_part;
    assign k           = K_W'(code[i]) + K_W'(in_i.scale.offset);
    assign octave      = k[K_W-1:PART_W];
    assign unused_part = ^k[PART_W-1:0];
    // octave - 11 above the zeros. At most 32 - 11.
    assign shift       = octave > OCTAVE_W'(zeros) + OCTAVE_W'(11) ? SHIFT_W'(octave) - SHIFT_W'(11) : zeros;
    morph_vertex u_morph (
      .clk_i, .rst_ni, .valid_i, .ready_o(ready[i]),
      .compact_i(compact), .shift_i(shift), .grid_i(in_i.grid), .s_i(s[i]),
      .fa_i(fa[i]), .fb_i(fb[i]), .pa_i(pa[i]), .pb_i(pb[i]), .v_i(v[i]),
      .valid_o(valid[i]), .ready_i, .full_o(full[i]), .morphed_o(morphed[i])
    );
  end

  pipe_delay #(.W(TAG_W), .STAGES(lod_pkg::TESSELLATE_LATENCY)) u_tag (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i(tag_i), .valid_o, .ready_i, .data_o(tag_o)
  );
  assign out_o = {lod_pkg::whole_point(full[0]), lod_pkg::whole_point(full[1]), lod_pkg::whole_point(full[2]),
                  lod_pkg::whole_point(morphed[0]), lod_pkg::whole_point(morphed[1]), lod_pkg::whole_point(morphed[2])};

  logic unused_lockstep;
  assign unused_lockstep = ^{valid, ready};

endmodule

`default_nettype wire
