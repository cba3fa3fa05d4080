`default_nettype none

/// The four children of a node against a ray: their boxes for this ray, tested, and sorted. Twin of src/block/child_test.rs (paper figure 9).
///
/// One `child_boxes`, four `box_test` and one `child_sort` in a row. A child that is not present is never hit. Legal: what the parts ask for. Latency: the sum of
/// the three; interval 1.
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

  localparam int unsigned BOXES = lod_pkg::CHILD_BOXES_LATENCY;
  localparam int unsigned TEST = lod_pkg::BOX_TEST_LATENCY;
  localparam int unsigned SORT = lod_pkg::CHILD_SORT_LATENCY;
  localparam int unsigned T_W = lod_pkg::T_NEAR_W;

  // Stages that are a `pipe_skid`: the last of child_boxes, and one of the box tests.
  localparam logic [63:0] BOXES_SKIDS = 64'd1 << (BOXES - 1);

  lod_pkg::child_boxes_in_t  boxes_in;
  lod_pkg::child_boxes_out_t boxes;
  logic                      valid_boxes, ready_boxes, ready_ray;
  assign boxes_in = {in_i.tree, in_i.origin, in_i.halves, in_i.exponents, in_i.planes, in_i.f0, in_i.f1, in_i.f2, in_i.g0, in_i.g1, in_i.g2,
                     in_i.p0, in_i.p1, in_i.p2, in_i.q0, in_i.q1, in_i.q2};
  child_boxes #(.TAG_W(1)) u_boxes (
    .clk_i, .rst_ni, .valid_i, .ready_o(ready_boxes), .in_i(boxes_in), .tag_i(1'b0),
    .valid_o(valid_boxes), .ready_i(ready_ray), .out_o(boxes), .tag_o()
  );

  // The ray waits for the boxes.
  lod_pkg::ray_setup_out_t     ray_q;
  logic [lod_pkg::RAY_T_W-1:0] t_max_q;
  logic [3:0]                  present_q;
  logic                        valid_ray;
  pipe_delay #(.W(lod_pkg::RAY_SETUP_OUT_W + lod_pkg::RAY_T_W + 4), .STAGES(BOXES), .SKIDS(BOXES_SKIDS)) u_ray (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({in_i.ray, in_i.t_max, in_i.present}),
    .valid_o(valid_ray), .ready_i(ready_ray), .data_o({ray_q, t_max_q, present_q})
  );

  logic [3:0]          ready_box, valid_box, hit;
  logic [3:0][T_W-1:0] t_near;
  logic                ready_test;
  for (genvar k = 0; k < 4; k++) begin : g_child
    lod_pkg::box_test_in_t  test_in;
    lod_pkg::box_test_out_t test_out;
    assign test_in = {ray_q, t_max_q, boxes.bounds[k]};
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

  pipe_delay #(.W(TAG_W), .STAGES(BOXES + TEST + SORT), .SKIDS(BOXES_SKIDS | lod_pkg::BOX_TEST_SKIDS << BOXES)) u_tag (
    .clk_i, .rst_ni, .valid_i, .ready_o(), .data_i(tag_i), .valid_o(), .ready_i, .data_o(tag_o)
  );

  logic unused_lockstep;
  assign unused_lockstep = ^{valid_boxes, ready_boxes, ready_box[3:1], valid_box[3:1]};

endmodule

`default_nettype wire
