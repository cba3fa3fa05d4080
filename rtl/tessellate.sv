`default_nettype none

/// Inserted vertices of a node's triangle for this ray: morphed between edge midpoint and stored position. Twin of src/block/tessellate.rs (paper section 3.4).
///
/// Nine `morph_coordinate` in lockstep: q_i lies on the edge between the two corners that are not p_i, and opens by s_i.
/// Legal: corners multiples of 2^(grid+1), q of 2^grid, grid 0 to 9, |v| < 2^31, s 0 to 256. Latency TESSELLATE_LATENCY; interval 1.
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

  localparam int unsigned W = lod_pkg::POINT_W / 3;

  // Per vertex: the ends of its edge, its stored place and its state.
  logic [2:0][lod_pkg::POINT_W-1:0]      a, b, q, morphed;
  logic [2:0][lod_pkg::EDGE_STATE_W-1:0] s;
  logic [8:0]                            valid, ready;
  assign a = {in_i.p0, in_i.p2, in_i.p1};
  assign b = {in_i.p1, in_i.p0, in_i.p2};
  assign q = {in_i.q2, in_i.q1, in_i.q0};
  assign s = {in_i.s2, in_i.s1, in_i.s0};

  for (genvar i = 0; i < 3; i++) begin : g_vertex
    for (genvar k = 0; k < 3; k++) begin : g_coordinate
      morph_coordinate u_morph (
        .clk_i, .rst_ni, .valid_i, .ready_o(ready[3*i+k]),
        .a_i(a[i][k*W +: W]), .b_i(b[i][k*W +: W]), .q_i(q[i][k*W +: W]), .s_i(s[i]), .grid_i(in_i.grid),
        .valid_o(valid[3*i+k]), .ready_i, .morphed_o(morphed[i][k*W +: W])
      );
    end
  end

  pipe_delay #(.W(TAG_W), .STAGES(lod_pkg::TESSELLATE_LATENCY)) u_tag (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i(tag_i), .valid_o, .ready_i, .data_o(tag_o)
  );
  assign out_o = {morphed[0], morphed[1], morphed[2]};

  logic unused_lockstep;
  assign unused_lockstep = ^{valid, ready};

endmodule

`default_nettype wire
