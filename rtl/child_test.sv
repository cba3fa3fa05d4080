`default_nettype none

/// The four children of a node against a ray: their boxes for this ray, tested, and sorted. Twin of src/block/child_test.rs (paper figure 9).
///
/// One `child_boxes`, BOXES_PER_CYCLE `box_test` and one `child_sort` in a row. Where there are fewer tests than children, these go through in passes, the lowest
/// numbers first. A child that is not present is never hit. Legal: what the parts ask for; BOXES_PER_CYCLE 4, 2 or 1. Latency: the sum of the three, and a cycle for
/// each pass but the first; interval 4 / BOXES_PER_CYCLE.
module child_test #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned BOXES_PER_CYCLE = lod_pkg::BOXES_PER_CYCLE
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

  localparam int unsigned B = BOXES_PER_CYCLE;
  localparam int unsigned PASSES = 4 / B;
  localparam int unsigned BOXES = lod_pkg::CHILD_BOXES_LATENCY;
  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  localparam int unsigned BOX_W = lod_pkg::BOX16_W;
  // What goes with the first child of a pass: the tag, which of them are there, and which pass it is.
  localparam int unsigned PASS_W = $clog2(PASSES);
  localparam int unsigned BESIDE_W = TAG_W + B + PASS_W;
  if (B != 4 && B != 2 && B != 1) begin : g_illegal_boxes
    $error("child_test: BOXES_PER_CYCLE = %0d, must be 4, 2 or 1", B);
  end

  // Stages that are a `pipe_skid`: the last of child_boxes; and one of the box tests.
  localparam logic [63:0] BOXES_SKIDS = 64'd1 << (BOXES - 1);

  // No sooner than the passes of the node before make room.
  logic take, open, ready_boxes, ready_ray;
  assign take    = valid_i && open;
  assign ready_o = ready_ray && open;

  lod_pkg::child_boxes_in_t  boxes_in;
  lod_pkg::child_boxes_out_t boxes;
  logic                      valid_boxes, next_node;
  always_comb begin
    boxes_in.tree      = in_i.tree;
    boxes_in.origin    = in_i.origin;
    boxes_in.halves    = in_i.halves;
    boxes_in.exponents = in_i.exponents;
    boxes_in.planes    = in_i.planes;
    boxes_in.f0        = in_i.f0;
    boxes_in.f1        = in_i.f1;
    boxes_in.f2        = in_i.f2;
    boxes_in.g0        = in_i.g0;
    boxes_in.g1        = in_i.g1;
    boxes_in.g2        = in_i.g2;
    boxes_in.p0        = in_i.p0;
    boxes_in.p1        = in_i.p1;
    boxes_in.p2        = in_i.p2;
    boxes_in.q0        = in_i.q0;
    boxes_in.q1        = in_i.q1;
    boxes_in.q2        = in_i.q2;
  end
  child_boxes #(.TAG_W(1)) u_boxes (
    .clk_i, .rst_ni, .valid_i(take), .ready_o(ready_boxes), .in_i(boxes_in), .tag_i(1'b0),
    .valid_o(valid_boxes), .ready_i(next_node), .out_o(boxes), .tag_o()
  );

  // The ray waits for the boxes.
  lod_pkg::ray_setup_out_t     ray_q;
  logic [lod_pkg::RAY_T_W-1:0] t_max_q;
  logic [3:0]                  present_q;
  logic [TAG_W-1:0]            tag_q;
  logic                        valid_ray;
  pipe_delay #(.W(lod_pkg::RAY_SETUP_OUT_W + lod_pkg::RAY_T_W + 4 + TAG_W), .STAGES(BOXES), .SKIDS(BOXES_SKIDS)) u_ray (
    .clk_i, .rst_ni, .valid_i(take), .ready_o(ready_ray), .data_i({in_i.ray, in_i.t_max, in_i.present, tag_i}),
    .valid_o(valid_ray), .ready_i(next_node), .data_o({ray_q, t_max_q, present_q, tag_q})
  );

  // The children of this pass, and what goes with them.
  logic [B-1:0][BOX_W-1:0] bounds;
  logic [BESIDE_W-1:0]     beside, beside_there;
  logic [B-1:0]            ready_box, valid_box, hit, present_there, hit_there;
  logic [B-1:0][T_W-1:0]   t_near, t_near_there;
  logic                    ready_test;
  for (genvar k = 0; k < B; k++) begin : g_child
    localparam int unsigned WITH_W = k == 0 ? BESIDE_W : 1;
    logic [WITH_W-1:0]      with_it, with_it_there;
    lod_pkg::box_test_in_t  test_in;
    lod_pkg::box_test_out_t test_out;
    if (k == 0) begin : g_first
      assign with_it      = beside;
      assign beside_there = with_it_there;
    end else begin : g_other
      logic unused_tag;
      assign with_it    = 1'b0;
      assign unused_tag = with_it_there;
    end
    always_comb begin
      test_in.ray    = ray_q;
      test_in.t_max  = t_max_q;
      test_in.bounds = bounds[k];
    end
    box_test #(.TAG_W(WITH_W)) u_test (
      .clk_i, .rst_ni, .valid_i(valid_ray), .ready_o(ready_box[k]), .in_i(test_in), .tag_i(with_it),
      .valid_o(valid_box[k]), .ready_i(ready_test), .out_o(test_out), .tag_o(with_it_there)
    );
    assign hit[k]    = test_out.hit;
    assign t_near[k] = test_out.t_near;
  end

  // Children that are not there neither count nor have a distance.
  logic [TAG_W-1:0] tag_there;
  assign {tag_there, present_there} = beside_there[TAG_W+B-1:0];
  for (genvar k = 0; k < B; k++) begin : g_there
    assign hit_there[k]    = hit[k] && present_there[k];
    assign t_near_there[k] = present_there[k] ? t_near[k] : '0;
  end

  lod_pkg::child_sort_in_t  sort_in;
  lod_pkg::child_sort_out_t sorted;
  logic [3:0][T_W-1:0]      t_near_all, t_near_last;
  logic                     valid_all, ready_all;
  if (PASSES == 1) begin : g_at_once
    assign open       = 1'b1;
    assign next_node  = ready_box[0];
    assign bounds     = boxes.bounds;
    assign beside     = {tag_q, present_q};
    assign valid_all  = valid_box[0];
    assign ready_test = ready_all;
    assign sort_in    = {hit_there, t_near_there};
    assign t_near_all = t_near_there;
  end else begin : g_passes
    localparam logic [PASS_W-1:0] LAST = PASS_W'(PASSES - 1);

    // The pass of the node at the tests, and cycles until the next node may come.
    logic [PASS_W-1:0] pass_q, wait_q, pass_there;
    assign open      = wait_q == '0;
    assign next_node = ready_box[0] && pass_q == LAST;
    always_ff @(posedge clk_i) begin
      if (!rst_ni) begin
        pass_q <= '0;
        wait_q <= '0;
      end else begin
        if (valid_ray && ready_box[0]) pass_q <= pass_q + PASS_W'(1);
        if (take && ready_o) wait_q <= LAST;
        else if (!open) wait_q <= wait_q - PASS_W'(1);
      end
    end
    // Flat vectors: Yosys does not see the width of an array that is declared here.
    logic [4*BOX_W-1:0] all_bounds;
    logic [B-1:0]       present;
    assign all_bounds = boxes.bounds;
    always_comb begin
      bounds  = '0;
      present = '0;
      for (int unsigned p = 0; p < PASSES; p++) begin
        for (int unsigned k = 0; k < B; k++) begin
          if (pass_q == PASS_W'(p)) begin
            bounds[k]  = all_bounds[(B*p+k)*BOX_W +: BOX_W];
            present[k] = present_q[B*p+k];
          end
        end
      end
    end
    assign beside = {pass_q, tag_q, present};

    // Those of earlier passes wait for the last, the first of them in the lowest place.
    logic                 last;
    logic [4-B-1:0]       hit_q;
    logic [(4-B)*T_W-1:0] t_near_q;
    logic [3:0]           hit_all;
    logic [4*T_W-1:0]     t_near_turned;
    assign pass_there    = beside_there[BESIDE_W-1 -: PASS_W];
    assign last          = pass_there == LAST;
    assign valid_all     = valid_box[0] && last;
    assign ready_test    = ready_all || !last;
    assign hit_all       = {hit_there, hit_q};
    assign t_near_turned = {t_near_there, t_near_q};
    assign t_near_all    = t_near_turned;
    assign sort_in       = {hit_all, t_near_turned};
    always_ff @(posedge clk_i) begin
      if (valid_box[0] && !last) {hit_q, t_near_q} <= {hit_all[3:B], t_near_turned[4*T_W-1:B*T_W]};
    end
  end

  child_sort #(.TAG_W(4 * T_W + TAG_W)) u_sort (
    .clk_i, .rst_ni, .valid_i(valid_all), .ready_o(ready_all), .in_i(sort_in), .tag_i({t_near_all, tag_there}),
    .valid_o, .ready_i, .out_o(sorted), .tag_o({t_near_last, tag_o})
  );
  assign out_o = {sorted, t_near_last};

  logic unused_lockstep;
  assign unused_lockstep = ^{valid_boxes, ready_boxes, ready_box >> 1, valid_box >> 1};

endmodule

`default_nettype wire
