`default_nettype none

/// The four children of a node against a ray: boxes widened by their morphed triangles, tested, and sorted. Twin of src/block/child_test.rs (paper figure 9).
///
/// Four `widen_box`, four `box_test` and one `child_sort` in a row. Where `widen` is low a box is widened by its own corner, which changes nothing. A child
/// that is not present is never hit. Legal: what the parts ask for. Latency: the sum of the three; interval 1.
module child_test #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::child_test_in_t  in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::child_test_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  localparam int unsigned WIDEN = lod_pkg::WIDEN_BOX_LATENCY;
  localparam int unsigned TEST = lod_pkg::BOX_TEST_LATENCY;
  localparam int unsigned SORT = lod_pkg::CHILD_SORT_LATENCY;
  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  localparam int unsigned POINT_W = lod_pkg::POINT_W;

  // Stages that are a `pipe_skid`: the last of widen_box, and one of the box tests.
  localparam logic [63:0] WIDEN_SKIDS = 64'd1 << (WIDEN - 1);

  // Corners of the four children (docs/numbers.md).
  logic [3:0][3*POINT_W-1:0] corners;
  assign corners[0] = {in_i.p0, in_i.q2, in_i.q1};
  assign corners[1] = {in_i.q2, in_i.p1, in_i.q0};
  assign corners[2] = {in_i.q1, in_i.q0, in_i.p2};
  assign corners[3] = {in_i.q0, in_i.q1, in_i.q2};

  // The ray waits for the boxes.
  lod_pkg::ray_setup_out_t     ray_q;
  logic [lod_pkg::RAY_T_W-1:0] t_max_q;
  logic [3:0]                  present_q;
  logic                        valid_ray, ready_ray;
  pipe_delay #(.W(lod_pkg::RAY_SETUP_OUT_W + lod_pkg::RAY_T_W + 4), .STAGES(WIDEN), .SKIDS(WIDEN_SKIDS)) u_ray (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({in_i.ray, in_i.t_max, in_i.present}),
    .valid_o(valid_ray), .ready_i(ready_ray), .data_o({ray_q, t_max_q, present_q})
  );

  logic [3:0]          valid_widen, ready_widen, ready_box, valid_box, hit;
  logic [3:0][T_W-1:0] t_near;
  logic                ready_test;
  for (genvar k = 0; k < 4; k++) begin : g_child
    lod_pkg::box16_t         stored;
    lod_pkg::point_t         corner;
    lod_pkg::widen_box_in_t  widen_in;
    lod_pkg::widen_box_out_t widened;
    lod_pkg::box_test_in_t   test_in;
    lod_pkg::box_test_out_t  test_out;
    assign stored   = in_i.bounds[k];
    assign corner   = {stored.lo.x, 16'd0, stored.lo.y, 16'd0, stored.lo.z, 16'd0};
    assign widen_in = {stored, in_i.widen ? corners[k] : {corner, corner, corner}};
    widen_box #(.TAG_W(1)) u_widen (
      .clk_i, .rst_ni, .valid_i, .ready_o(ready_widen[k]), .in_i(widen_in), .tag_i(1'b0),
      .valid_o(valid_widen[k]), .ready_i(ready_ray), .out_o(widened), .tag_o()
    );
    assign test_in = {ray_q, t_max_q, widened};
    box_test #(.TAG_W(1)) u_test (
      .clk_i, .rst_ni, .valid_i(valid_ray), .ready_o(ready_box[k]), .in_i(test_in), .tag_i(1'b0),
      .valid_o(valid_box[k]), .ready_i(ready_test), .out_o(test_out), .tag_o()
    );
    assign hit[k]    = test_out.hit;
    assign t_near[k] = test_out.t_near;
  end
  assign ready_ray = ready_box[0];

  // Children that are not there neither count nor have a distance.
  logic [3:0]          present_there, hit_there;
  logic [3:0][T_W-1:0] t_near_there, t_near_last;
  pipe_delay #(.W(4), .STAGES(TEST), .SKIDS(lod_pkg::BOX_TEST_SKIDS)) u_present (
    .clk_i, .rst_ni, .valid_i(valid_ray), .ready_o(), .data_i(present_q), .valid_o(), .ready_i(ready_test), .data_o(present_there)
  );
  for (genvar k = 0; k < 4; k++) begin : g_there
    assign hit_there[k]    = hit[k] && present_there[k];
    assign t_near_there[k] = present_there[k] ? t_near[k] : '0;
  end

  lod_pkg::child_sort_in_t  sort_in;
  lod_pkg::child_sort_out_t sorted;
  assign sort_in = {hit_there, t_near_there};
  child_sort #(.TAG_W(4 * T_W)) u_sort (
    .clk_i, .rst_ni, .valid_i(valid_box[0]), .ready_o(ready_test), .in_i(sort_in), .tag_i(t_near_there),
    .valid_o, .ready_i, .out_o(sorted), .tag_o(t_near_last)
  );
  assign out_o = {sorted, t_near_last};

  pipe_delay #(.W(TAG_W), .STAGES(WIDEN + TEST + SORT), .SKIDS(WIDEN_SKIDS | lod_pkg::BOX_TEST_SKIDS << WIDEN)) u_tag (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(tag_i), .valid_o(), .ready_i, .data_o(tag_o)
  );

  logic unused_lockstep;
  assign unused_lockstep = ^{valid_widen, ready_widen, ready_box[3:1], valid_box[3:1]};

endmodule

`default_nettype wire
