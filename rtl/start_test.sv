`default_nettype none

/// Ray from an exact start against one triangle. Twin of src/block/start_test.rs.
///
/// The ray starts at x = X + f / 2^31. As tri_test decides, on numbers relative to x: u = d.(b x c), v = d.(c x a), w = d.(a x b), det = u + v + w, t_num = a.(b x c), all exact, in steps
/// of 2^-31 but for det, which is a whole number; ties by the first non-zero component of the exact p x q. v, w and t_num are rounded down, `below` has what is left of them.
/// Legal: |v| < 2^31 for X and corners, |d| <= 2^30 and each |d_i| < 2^30. On a miss all numbers are 0. On a hit they are taken with det > 0.
///
/// EDGES_PER_CYCLE = 3: latency START_TEST_3_LATENCY, interval 1; 312 multipliers. 1: latency START_TEST_1_LATENCY, interval START_TEST_1_INTERVAL; 104.
module start_test #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned EDGES_PER_CYCLE = lod_pkg::EDGES_PER_CYCLE
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::start_test_in_t  in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::start_test_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  localparam int unsigned W = lod_pkg::WHOLE_RELATIVE_W;
  localparam int unsigned F_W = lod_pkg::FRACTION_W;
  localparam int unsigned EDGE_W = lod_pkg::EXACT_EDGE_W;
  localparam int unsigned T_W = lod_pkg::EXACT_T_W;
  localparam int unsigned LATENCY = 1 + lod_pkg::START_EDGE_LATENCY + 1 + lod_pkg::TRI_DECIDE_LATENCY;

  if (lod_pkg::START_TEST_3_LATENCY != LATENCY) begin : g_illegal_latency
    $error("start_test: lod_pkg::START_TEST_3_LATENCY must be %0d", LATENCY);
  end
  if (lod_pkg::START_TEST_1_LATENCY != LATENCY + 1 || lod_pkg::START_TEST_1_INTERVAL != 3) begin : g_illegal_timing
    $error("start_test: two further passes make lod_pkg::START_TEST_1_LATENCY %0d and START_TEST_1_INTERVAL 3", LATENCY + 1);
  end

  logic [3*W-1:0]   a, b, c;
  logic [3*F_W-1:0] f;
  assign a = lod_pkg::whole_relative(in_i.p0, in_i.start.point);
  assign b = lod_pkg::whole_relative(in_i.p1, in_i.start.point);
  assign c = lod_pkg::whole_relative(in_i.p2, in_i.start.point);
  // x first, as in a vector.
  assign f = {in_i.start.fraction[0], in_i.start.fraction[1], in_i.start.fraction[2]};

  logic              valid_edges, ready_edges, tie_u, tie_v, tie_w;
  logic [EDGE_W-1:0] u, v, w;
  logic [T_W-1:0]    t_num;
  logic [TAG_W-1:0]  tag;
  if (EDGES_PER_CYCLE == 3) begin : g_parallel
    start_edges_parallel #(.TAG_W(TAG_W)) u_edges (
      .clk_i, .rst_ni, .valid_i, .ready_o, .a_i(a), .b_i(b), .c_i(c), .f_i(f), .d_i(in_i.direction), .tag_i,
      .valid_o(valid_edges), .ready_i(ready_edges), .u_o(u), .v_o(v), .w_o(w),
      .tie_u_o(tie_u), .tie_v_o(tie_v), .tie_w_o(tie_w), .t_num_o(t_num), .tag_o(tag)
    );
  end else if (EDGES_PER_CYCLE == 1) begin : g_serial
    start_edges_serial #(.TAG_W(TAG_W)) u_edges (
      .clk_i, .rst_ni, .valid_i, .ready_o, .a_i(a), .b_i(b), .c_i(c), .f_i(f), .d_i(in_i.direction), .tag_i,
      .valid_o(valid_edges), .ready_i(ready_edges), .u_o(u), .v_o(v), .w_o(w),
      .tie_u_o(tie_u), .tie_v_o(tie_v), .tie_w_o(tie_w), .t_num_o(t_num), .tag_o(tag)
    );
  end else begin : g_illegal_edges
    $error("start_test: EDGES_PER_CYCLE = %0d, must be 1 or 3", EDGES_PER_CYCLE);
  end

  logic              hit, front;
  logic [EDGE_W-2:0] v_out, w_out, det_out;
  logic [T_W-2:0]    t_num_out;
  tri_decide #(.TAG_W(TAG_W), .EDGE_W(EDGE_W), .T_W(T_W)) u_decide (
    .clk_i, .rst_ni, .valid_i(valid_edges), .ready_o(ready_edges), .u_i(u), .v_i(v), .w_i(w),
    .tie_u_i(tie_u), .tie_v_i(tie_v), .tie_w_i(tie_w), .t_num_i(t_num), .tag_i(tag),
    .valid_o, .ready_i, .out_o({hit, front, v_out, w_out, det_out, t_num_out}), .tag_o
  );
  assign out_o = {hit, front, v_out[EDGE_W-2:F_W], w_out[EDGE_W-2:F_W], det_out[EDGE_W-2:F_W], t_num_out[T_W-2:F_W],
                  v_out[F_W-1:0], w_out[F_W-1:0], t_num_out[F_W-1:0]};

  // The fractions cancel in det.
  logic [F_W-1:0] unused_det;
  assign unused_det = det_out[F_W-1:0];

endmodule

`default_nettype wire
