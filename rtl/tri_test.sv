`default_nettype none

/// Ray against one triangle: exact Plücker test with a tie rule (paper appendix A). Twin of src/block/tri_test.rs.
///
/// With a, b, c relative to the origin: u = d.(b x c), v = d.(c x a), w = d.(a x b), det = u + v + w, t_num = a.(b x c), all exact.
/// Sign of an edge function d.(p x q): its own; if 0, that of the first non-zero component of p x q; if p x q = 0, either
/// (that of q - p, or positive): t_num is then 0.
/// Hit iff the three signs agree, det != 0 and t_num / det > 0; front face iff det < 0.
/// Legal: |v| < 2^31 for points and origin, |d| <= 2^30 and each |d_i| < 2^30. On a miss all numbers are 0. On a hit they are taken with det > 0.
///
/// Low bits that are always 0 are left out on the way (COORDINATE_ZEROS, DIRECTION_ZEROS); 168 and 56 multipliers without them.
/// EDGES_PER_CYCLE = 3: latency TRI_TEST_3_LATENCY, interval 1. 1: latency TRI_TEST_1_LATENCY, interval TRI_TEST_1_INTERVAL.
module tri_test #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned EDGES_PER_CYCLE = lod_pkg::EDGES_PER_CYCLE
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   valid_i,
  output logic                   ready_o,
  input  lod_pkg::tri_test_in_t  in_i,
  input  logic [TAG_W-1:0]       tag_i,
  output logic                   valid_o,
  input  logic                   ready_i,
  output lod_pkg::tri_test_out_t out_o,
  output logic [TAG_W-1:0]       tag_o
);

  localparam int unsigned W = lod_pkg::RELATIVE_W;
  localparam int unsigned D_W = lod_pkg::KEPT_DIRECTION_W;
  localparam int unsigned EDGE_W = lod_pkg::SIGNED_EDGE_W;
  localparam int unsigned LATENCY = 1 + lod_pkg::EDGE_FUNCTION_LATENCY + lod_pkg::TRI_DECIDE_LATENCY;

  if (lod_pkg::TRI_TEST_3_LATENCY != LATENCY) begin : g_illegal_latency
    $error("tri_test: lod_pkg::TRI_TEST_3_LATENCY must be %0d", LATENCY);
  end
  if (lod_pkg::TRI_TEST_1_LATENCY != lod_pkg::TRI_TEST_3_LATENCY + 2 || lod_pkg::TRI_TEST_1_INTERVAL != 3) begin : g_illegal_timing
    $error("tri_test: two further passes make lod_pkg::TRI_TEST_1_LATENCY %0d and TRI_TEST_1_INTERVAL 3", lod_pkg::TRI_TEST_3_LATENCY + 2);
  end

  lod_pkg::kept_point_t origin;
  logic [3*W-1:0]       a, b, c;
  logic [D_W-1:0]       d;
  assign origin = lod_pkg::keep_point(in_i.origin);
  assign a      = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p0), origin);
  assign b      = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p1), origin);
  assign c      = lod_pkg::relative_corner(lod_pkg::keep_point(in_i.p2), origin);
  assign d      = lod_pkg::keep_direction(in_i.direction);

  logic                                     valid_edges, ready_edges;
  logic [EDGE_W-1:0]                        u, v, w;
  logic                                     tie_u, tie_v, tie_w;
  logic [lod_pkg::SIGNED_T_NUMERATOR_W-1:0] t_num;
  logic [TAG_W-1:0]                         tag;
  if (EDGES_PER_CYCLE == 3) begin : g_parallel
    tri_edges_parallel #(.TAG_W(TAG_W)) u_edges (
      .clk_i, .rst_ni, .valid_i, .ready_o, .a_i(a), .b_i(b), .c_i(c), .d_i(d), .tag_i,
      .valid_o(valid_edges), .ready_i(ready_edges), .u_o(u), .v_o(v), .w_o(w),
      .tie_u_o(tie_u), .tie_v_o(tie_v), .tie_w_o(tie_w), .t_num_o(t_num), .tag_o(tag)
    );
  end else if (EDGES_PER_CYCLE == 1) begin : g_serial
    tri_edges_serial #(.TAG_W(TAG_W)) u_edges (
      .clk_i, .rst_ni, .valid_i, .ready_o, .a_i(a), .b_i(b), .c_i(c), .d_i(d), .tag_i,
      .valid_o(valid_edges), .ready_i(ready_edges), .u_o(u), .v_o(v), .w_o(w),
      .tie_u_o(tie_u), .tie_v_o(tie_v), .tie_w_o(tie_w), .t_num_o(t_num), .tag_o(tag)
    );
  end else begin : g_illegal_edges
    $error("tri_test: EDGES_PER_CYCLE = %0d, must be 1 or 3", EDGES_PER_CYCLE);
  end

  logic                                     hit, front;
  logic [EDGE_W-2:0]                        v_out, w_out, det_out;
  logic [lod_pkg::SIGNED_T_NUMERATOR_W-2:0] t_num_out;
  tri_decide #(.TAG_W(TAG_W)) u_decide (
    .clk_i, .rst_ni, .valid_i(valid_edges), .ready_o(ready_edges), .u_i(u), .v_i(v), .w_i(w),
    .tie_u_i(tie_u), .tie_v_i(tie_v), .tie_w_i(tie_w), .t_num_i(t_num), .tag_i(tag),
    .valid_o, .ready_i, .out_o({hit, front, v_out, w_out, det_out, t_num_out}), .tag_o
  );
  // With the zeros that were left out.
  assign out_o = {hit, front, lod_pkg::EDGE_FUNCTION_W'(v_out) << lod_pkg::EDGE_ZEROS, lod_pkg::EDGE_FUNCTION_W'(w_out) << lod_pkg::EDGE_ZEROS,
                  lod_pkg::EDGE_FUNCTION_W'(det_out) << lod_pkg::EDGE_ZEROS, lod_pkg::T_NUMERATOR_W'(t_num_out) << 3 * lod_pkg::COORDINATE_ZEROS};

endmodule

`default_nettype wire
