`default_nettype none

/// The four children of a tree's node against a ray: their prisms, tested, and sorted. Twin of src/block/child_prisms.rs (paper figure 9, with prisms for its boxes).
///
/// One `prism_frame`, PRISMS_PER_CYCLE `prism_test` and one `child_sort` in a row. Where there are fewer tests than children, these go through in passes, the lowest
/// numbers first. Legal: what the parts ask for; PRISMS_PER_CYCLE 4, 2 or 1. Latency: the sum of the three, and a cycle for each pass but the first; interval
/// 4 / PRISMS_PER_CYCLE.
module child_prisms #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned PRISMS_PER_CYCLE = 1
) (
  input  logic                      clk_i,
  input  logic                      rst_ni,
  input  logic                      valid_i,
  output logic                      ready_o,
  input  lod_pkg::child_prisms_in_t in_i,
  input  logic [TAG_W-1:0]          tag_i,
  output logic                      valid_o,
  input  logic                      ready_i,
  output lod_pkg::child_test_out_t  out_o,
  output logic [TAG_W-1:0]          tag_o
);

  localparam int unsigned B = PRISMS_PER_CYCLE;
  localparam int unsigned PASSES = 4 / B;
  localparam int unsigned FRAME = lod_pkg::PRISM_FRAME_LATENCY;
  localparam int unsigned T_W = lod_pkg::T_NEAR_W;
  localparam int unsigned CORNER_W = lod_pkg::LOCAL_W;
  localparam int unsigned PLANES_W = 5 * 3;
  // Codes of all children and the exponents of their steps.
  localparam int unsigned CODES_W = 4 * PLANES_W + 3 + 4;
  // What goes with the first child of a pass: the tag, and which pass it is.
  localparam int unsigned PASS_W = $clog2(PASSES);
  localparam int unsigned BESIDE_W = TAG_W + PASS_W;
  if (B != 4 && B != 2 && B != 1) begin : g_illegal_prisms
    $error("child_prisms: PRISMS_PER_CYCLE = %0d, must be 4, 2 or 1", B);
  end

  // The last stage of prism_frame is a `pipe_skid`.
  localparam logic [63:0] FRAME_SKIDS = 64'd1 << (FRAME - 1);

  // No sooner than the passes of the node before make room.
  logic take, open, ready_frame, ready_codes;
  assign take    = valid_i && open;
  assign ready_o = ready_codes && open;

  lod_pkg::prism_frame_in_t  frame_in;
  lod_pkg::prism_frame_out_t node;
  logic                      valid_frame, next_node;
  assign frame_in = {in_i.ray, in_i.full, in_i.morphed};
  prism_frame #(.TAG_W(1)) u_frame (
    .clk_i, .rst_ni, .valid_i(take), .ready_o(ready_frame), .in_i(frame_in), .tag_i(1'b0),
    .valid_o(valid_frame), .ready_i(next_node), .out_o(node), .tag_o()
  );

  // Codes and the ray's end wait for the frame.
  logic [T_W-1:0]      t_max_q;
  logic [2:0]          reach_q;
  logic [3:0]          height_q;
  logic [19:0][2:0]    planes_q;
  logic [TAG_W-1:0]    tag_q;
  logic                valid_codes;
  pipe_delay #(.W(T_W + CODES_W + TAG_W), .STAGES(FRAME), .SKIDS(FRAME_SKIDS)) u_codes (
    .clk_i, .rst_ni, .valid_i(take), .ready_o(ready_codes),
    .data_i({in_i.t_max[lod_pkg::RAY_T_W-1:lod_pkg::T_NEAR_TO_T_SHIFT], in_i.reach, in_i.height, in_i.planes, tag_i}),
    .valid_o(valid_codes), .ready_i(next_node), .data_o({t_max_q, reach_q, height_q, planes_q, tag_q})
  );

  // Corners and codes of all children.
  logic [3:0][3*CORNER_W-1:0] all_corners;
  logic [3:0][PLANES_W-1:0]   all_planes;
  assign all_corners = {node.corners[5], node.corners[4], node.corners[3],
                        node.corners[2], node.corners[3], node.corners[4],
                        node.corners[3], node.corners[1], node.corners[5],
                        node.corners[4], node.corners[5], node.corners[0]};
  assign all_planes  = planes_q;

  // The children of this pass, and what goes with them.
  logic [B-1:0][3*CORNER_W-1:0] corners;
  logic [B-1:0][PLANES_W-1:0]   planes;
  logic [BESIDE_W-1:0]          beside, beside_there;
  logic [B-1:0]                 ready_test, valid_test, hit;
  logic [B-1:0][T_W-1:0]        t_near;
  logic                         ready_there;
  for (genvar k = 0; k < B; k++) begin : g_child
    localparam int unsigned WITH_W = k == 0 ? BESIDE_W : 1;
    logic [WITH_W-1:0]       with_it, with_it_there;
    lod_pkg::prism_test_in_t test_in;
    lod_pkg::box_test_out_t  test_out;
    if (k == 0) begin : g_first
      assign with_it      = beside;
      assign beside_there = with_it_there;
    end else begin : g_other
      logic unused_tag;
      assign with_it    = 1'b0;
      assign unused_tag = with_it_there;
    end
    assign test_in = {node.frame, t_max_q, lod_pkg::T_NEAR_TO_T_SHIFT'(0), corners[k], planes[k], reach_q, height_q};
    prism_test #(.TAG_W(WITH_W)) u_test (
      .clk_i, .rst_ni, .valid_i(valid_frame), .ready_o(ready_test[k]), .in_i(test_in), .tag_i(with_it),
      .valid_o(valid_test[k]), .ready_i(ready_there), .out_o(test_out), .tag_o(with_it_there)
    );
    assign hit[k]    = test_out.hit;
    assign t_near[k] = test_out.t_near;
  end

  logic [TAG_W-1:0] tag_there;
  assign tag_there = beside_there[TAG_W-1:0];

  lod_pkg::child_sort_in_t  sort_in;
  lod_pkg::child_sort_out_t sorted;
  logic [3:0][T_W-1:0]      t_near_all, t_near_last;
  logic                     valid_all, ready_all;
  if (PASSES == 1) begin : g_at_once
    assign open        = 1'b1;
    assign next_node   = ready_test[0];
    assign corners     = all_corners;
    assign planes      = all_planes;
    assign beside      = tag_q;
    assign valid_all   = valid_test[0];
    assign ready_there = ready_all;
    assign sort_in     = {hit, t_near};
    assign t_near_all  = t_near;
  end else begin : g_passes
    localparam logic [PASS_W-1:0] LAST = PASS_W'(PASSES - 1);

    // The pass of the node at the tests, and cycles until the next node may come.
    logic [PASS_W-1:0] pass_q, wait_q, pass_there;
    assign open      = wait_q == '0;
    assign next_node = ready_test[0] && pass_q == LAST;
    always_ff @(posedge clk_i) begin
      if (!rst_ni) begin
        pass_q <= '0;
        wait_q <= '0;
      end else begin
        if (valid_frame && ready_test[0]) pass_q <= pass_q + PASS_W'(1);
        if (take && ready_o) wait_q <= LAST;
        else if (!open) wait_q <= wait_q - PASS_W'(1);
      end
    end
    // Flat vectors: Yosys does not see the width of an array that is declared here.
    logic [12*CORNER_W-1:0] flat_corners;
    logic [4*PLANES_W-1:0]  flat_planes;
    assign flat_corners = all_corners;
    assign flat_planes  = all_planes;
    always_comb begin
      corners = '0;
      planes  = '0;
      for (int unsigned p = 0; p < PASSES; p++) begin
        for (int unsigned k = 0; k < B; k++) begin
          if (pass_q == PASS_W'(p)) begin
            corners[k] = flat_corners[(B*p+k)*3*CORNER_W +: 3*CORNER_W];
            planes[k]  = flat_planes[(B*p+k)*PLANES_W +: PLANES_W];
          end
        end
      end
    end
    assign beside = {pass_q, tag_q};

    // Those of earlier passes wait for the last, the first of them in the lowest place.
    logic                 last;
    logic [4-B-1:0]       hit_q;
    logic [(4-B)*T_W-1:0] t_near_q;
    logic [3:0]           hit_all;
    logic [4*T_W-1:0]     t_near_turned;
    assign pass_there    = beside_there[BESIDE_W-1 -: PASS_W];
    assign last          = pass_there == LAST;
    assign valid_all     = valid_test[0] && last;
    assign ready_there   = ready_all || !last;
    assign hit_all       = {hit, hit_q};
    assign t_near_turned = {t_near, t_near_q};
    assign t_near_all    = t_near_turned;
    assign sort_in       = {hit_all, t_near_turned};
    always_ff @(posedge clk_i) begin
      if (valid_test[0] && !last) {hit_q, t_near_q} <= {hit_all[3:B], t_near_turned[4*T_W-1:B*T_W]};
    end
  end

  child_sort #(.TAG_W(4 * T_W + TAG_W)) u_sort (
    .clk_i, .rst_ni, .valid_i(valid_all), .ready_o(ready_all), .in_i(sort_in), .tag_i({t_near_all, tag_there}),
    .valid_o, .ready_i, .out_o(sorted), .tag_o({t_near_last, tag_o})
  );
  assign out_o = {sorted, t_near_last};

  logic unused_lockstep;
  assign unused_lockstep = ^{in_i.t_max[lod_pkg::T_NEAR_TO_T_SHIFT-1:0], valid_codes, ready_frame, ready_test >> 1, valid_test >> 1};

endmodule

`default_nettype wire
