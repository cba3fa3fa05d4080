`default_nettype none

/// One ray under way: the state machine of the paper's figure 9, with its stack, its split triangles, its line buffers and its closest hit.
///
/// States, conditions and registers are those of docs/traversal-unit.md. A context asks for a block with `*_request_o`, holding the operands until
/// `*_grant_i`; the result comes with `*_valid_i`, later. It computes nothing itself but counts.
/// What cannot be done ends the ray early, before it is done; errors of memory and a flush are kept until the context waits for no block.
/// Only states, bits that ask for something, and what counts rays and lines are reset.
/// What happens in a cycle, and which registers it writes, is said once, in "Steps"; everything behind it is these registers.
module ray_context #(
  parameter bit WATCH = 1'b0,
  parameter bit MEMORY_PARITY = 1'b0
) (
  input  logic                             clk_i,
  input  logic                             rst_ni,
  input  lod_pkg::memory_test_t            memory_test_i,
  input  lod_pkg::scene_config_t           scene_i,
  // The scene is one for this hardware; every ray under way ends; the limit of answers has passed since the last tick; and an age of ticks since the last one.
  input  logic                             fits_i,
  input  logic                             flush_i,
  input  logic                             tick_i,
  input  logic                             age_i,
  // What it is doing, for who looks from outside; a memory of its gave another word than it took.
  output lod_pkg::context_view_t           view_o,
  output logic                             fault_o,
  // Ray in: `idle_o` is that it has none, `free_o` that it takes one.
  output logic                             idle_o,
  output logic                             free_o,
  input  logic                             take_i,
  input  lod_pkg::ray_in_t                 ray_i,
  input  lod_pkg::secondary_in_t           secondary_i,
  // ray_setup, or start_setup.
  output logic                             setup_request_o,
  output lod_pkg::start_setup_in_t         setup_o,
  input  logic                             setup_grant_i,
  input  logic                             setup_valid_i,
  input  lod_pkg::ray_setup_out_t          setup_i,
  // node_address and the memory behind it; `place_o` is the line's place: the line buffer that it goes to.
  output logic                             fetch_request_o,
  output logic                             fetch_place_o,
  output logic [lod_pkg::EPOCH_W-1:0]      fetch_epoch_o,
  output lod_pkg::node_address_in_t        fetch_o,
  input  logic                             fetch_grant_i,
  input  logic                             line_valid_i,
  input  lod_pkg::memory_answer_t          line_i,
  // The corners in this line, if it has those of a base triangle; whether they are none of such a scene.
  input  logic [3*lod_pkg::KEPT_POINT_W-1:0] line_corners_i,
  input  logic                             line_misplaced_i,
  // child_test.
  output logic                             child_request_o,
  output lod_pkg::child_test_in_t          child_o,
  input  logic                             child_grant_i,
  input  logic                             child_valid_i,
  input  lod_pkg::child_test_out_t         child_i,
  // tree_deciders.
  output logic                             decide_request_o,
  output lod_pkg::tree_deciders_in_t       decide_o,
  input  logic                             decide_grant_i,
  input  logic                             decide_valid_i,
  input  lod_pkg::tree_deciders_out_t      decide_i,
  // lod_test, or lod_test_by.
  output logic                             lod_request_o,
  output lod_pkg::lod_test_by_in_t         lod_o,
  input  logic                             lod_grant_i,
  input  logic                             lod_valid_i,
  input  lod_pkg::lod_test_out_t           lod_i,
  // tessellate: its operands but for the vertices, what these are in, and of compact ones the place: of short ones the node among its siblings, else whether they are in the upper half.
  // Of the inserted vertices that come, whether one lies beyond the largest coordinate, and their lowest bits together.
  output logic                             morph_request_o,
  output logic [lod_pkg::TESSELLATE_IN_W-3*lod_pkg::POINT_W-1:0] morph_o,
  output logic [3*lod_pkg::STORED_POINT_W-1:0] morph_line_o,
  output logic                             morph_short_o,
  output logic [1:0]                       morph_place_o,
  input  logic                             morph_grant_i,
  input  logic                             morph_valid_i,
  input  lod_pkg::tessellate_out_t         morph_i,
  input  logic                             morph_beyond_i,
  input  logic [15:0]                      morph_bits_i,
  // tri_test, or start_test; `number_o` tells the triangles of a context apart.
  output logic                             tri_request_o,
  output logic [1:0]                       tri_number_o,
  output lod_pkg::start_test_in_t          tri_o,
  input  logic                             tri_grant_i,
  input  logic                             tri_miss_i,
  // hit_select: `hit_number_i` is the triangle that t belongs to, `hit_front_i` its side; its numerators follow with the result.
  input  logic [1:0]                       hit_number_i,
  input  logic                             hit_front_i,
  input  logic [lod_pkg::RAY_T_W-1:0]      hit_t_i,
  output lod_pkg::hit_select_in_t          select_o,
  input  logic                             select_valid_i,
  input  lod_pkg::hit_select_out_t         select_i,
  input  logic [lod_pkg::RAY_T_W-1:0]      chosen_t_i,
  input  lod_pkg::queued_hit_t             chosen_i,
  // hit_divide, or start_divide, for the barycentrics; `divide_what_i` and `divide_valid_i` tell results apart.
  output logic                             divide_request_o,
  output logic [1:0]                       divide_what_o,
  output lod_pkg::start_divide_in_t        divide_o,
  input  logic                             divide_grant_i,
  input  logic                             divide_valid_i,
  input  logic [1:0]                       divide_what_i,
  input  lod_pkg::hit_divide_out_t         divide_i,
  // bary_map.
  output logic                             map_request_o,
  output lod_pkg::bary_map_in_t            map_o,
  input  logic                             map_grant_i,
  input  logic                             map_valid_i,
  input  lod_pkg::bary_map_out_t           map_i,
  // Hit out: the hit itself means nothing without `found`.
  output logic                             hit_request_o,
  output lod_pkg::hit_out_t                hit_o,
  output lod_pkg::corners_t                corners_o,
  input  logic                             hit_grant_i
);

  localparam int unsigned NODE_W = lod_pkg::KEPT_NODE_W;
  // What this hardware has.
  localparam bit SPLITTING = lod_pkg::STORED_LEVELS != 0;
  localparam bit CHOOSING = lod_pkg::LOD_TEST != 0;
  localparam bit MAPPING = lod_pkg::HIT_MAPPING != 0;
  localparam bit SECONDARY = lod_pkg::SECONDARY != 0;
  localparam bit DECIDING = SECONDARY && CHOOSING;
  // A vertex at full resolution and, where it is another, as morphed.
  localparam int unsigned CORNER_W = (CHOOSING ? 2 : 1) * lod_pkg::KEPT_POINT_W;
  localparam int unsigned SPLITS = lod_pkg::SPLIT_TRIANGLES;
  // Three inserted vertices.
  localparam int unsigned G_W = 3 * lod_pkg::KEPT_POINT_W;
  // Three stored points, or two times three displacements.
  localparam int unsigned LINE1_W = 3 * lod_pkg::STORED_POINT_W;

  // ---- Registers ----

  lod_pkg::context_state_t state_q, state_d;
  lod_pkg::fetch_t         fetch_q;

  // The ray.
  logic [31:0]              tag_q;
  lod_pkg::kept_point_t     origin_q;
  lod_pkg::kept_direction_t direction_q;
  lod_pkg::kept_setup_t     setup_q;

  // Where it is: entry under visit; tree, how many of its levels are stored, its place among those of each level; node; its triangle with inserted vertices, at full resolution (f, g) and as morphed (p, q); bound codes and edge states.
  logic [lod_pkg::KEPT_ENTRY_W-1:0] entry_q;
  lod_pkg::stack_entry_t            entry;
  logic [lod_pkg::INDEX_W-1:0]      tree_q;
  logic [lod_pkg::INDEX_W-1:0]      place;
  logic [3:0]                       depth, level;
  logic [NODE_W-1:0]                node;
  lod_pkg::kept_point_t             f0, f1, f2, g0, g1, g2, p0, p1, p2, q0, q1, q2;
  logic [lod_pkg::BOUND_CODE_W-1:0] e0, e1, e2;
  lod_pkg::lod_test_out_t           lod;
  assign entry = lod_pkg::whole_entry(entry_q);

  // Lines asked for and not yet sent, sent and not yet there, and there: a node, a record or a split; exact corners or vertices, or compact ones of a last split, and when `tessellate` has
  // taken these, what it gave for them at full resolution, as far as a line has room.
  logic [1:0]          want_q, waiting_q;
  logic [255:0]        line0_q;
  logic [LINE1_W-1:0]  line1_q;

  // Number of the ray among the context's: its lines come back with it. Why it ends early, how many entries it may still visit, and whether a tick has passed
  // since something came that it waits for.
  logic [lod_pkg::EPOCH_W-1:0] epoch_q;
  // Lines asked for by this ray and those before, and not there; rays before this one since there was none such; whether an age has passed since the context rests.
  logic [lod_pkg::OWED_W-1:0]  owed_q;
  logic [lod_pkg::BEHIND_W-1:0] behind_q;
  logic                        rested_q;
  lod_pkg::ray_error_t         error_q;
  logic [31:0]                 visits_q;
  logic                        stale_q;

  // Children still to be pushed.
  lod_pkg::child_test_out_t sorted_q;
  logic [2:0]               count_q;

  // Triangle tests: still to be sent (0 to 4), the next one's number, without a verdict yet (0 to 4); `four_q`: the four children, not the node itself.
  logic       four_q;
  logic [2:0] left_q, pending_q;
  logic [1:0] next_q;

  // ---- Records in the line buffers ----

  lod_pkg::l0_record_t record;
  assign record = line0_q;

  logic last_split, split_there, compact, vertices_in_split;
  // depth <= STORED_LEVELS and level < depth where this is used.
  assign last_split        = level + 4'd1 == depth;
  // Line 0 is a split.
  assign split_there       = fetch_q == lod_pkg::SPLIT;
  assign compact           = lod_pkg::EXACT_VERTICES == 0 || (lod_pkg::COMPACT_VERTICES != 0 && scene_i.compact);
  assign vertices_in_split = compact && (!last_split || level == '0);

  // ---- Closest hit ----

  // A triangle's level and node: this node, or its child of that number.
  logic [3:0]        hit_level;
  logic [NODE_W-1:0] hit_node, chosen_node;

  // Children of level N - 1 at most: their nodes are below 4^N.
  assign hit_level   = four_q ? level + 4'd1 : level;
  assign hit_node    = four_q ? NODE_W'({node, hit_number_i}) : node;
  assign chosen_node = four_q ? NODE_W'({node, chosen_i.number}) : node;

  logic                          known;
  logic [lod_pkg::RAY_T_W-1:0]   t_max;
  logic [lod_pkg::FULL_ID_W-1:0] best_id;
  lod_pkg::hit_t                 best;

  // What a ray has besides, where rays can start on a surface: its start below whole units, the smallest t that counts, and whether any hit serves.
  logic [3*lod_pkg::FRACTION_W-1:0] fraction;
  logic [lod_pkg::RAY_T_W-1:0]         t_min, largest_t;
  logic                                any;
  if (SECONDARY) begin : g_start
    logic [3*lod_pkg::FRACTION_W-1:0] fraction_q;
    logic [lod_pkg::RAY_T_W-1:0]         t_min_q;
    logic                                any_q;
    always_ff @(posedge clk_i) begin
      if (take_i) {fraction_q, t_min_q, any_q} <= {secondary_i.fraction, secondary_i.t_min, secondary_i.any};
    end
    assign {fraction, t_min, any} = {fraction_q, t_min_q, any_q};
    assign largest_t              = secondary_i.t_max;
  end else begin : g_whole
    logic unused_start;
    assign {fraction, t_min, any} = '0;
    assign largest_t              = '1;
    assign unused_start           = ^{secondary_i.t_min, secondary_i.t_max, secondary_i.any, secondary_i.fraction};
  end

  logic closer;
  closest_hit u_closest (
    .clk_i,
    .levels_i(scene_i.levels),
    .clear_i(take_i), .t_min_i(t_min), .largest_t_i(largest_t),
    .known_o(known), .t_max_o(t_max), .id_o(best_id),
    .select_valid_i, .select_i,
    .t_i(chosen_t_i), .tree_i(tree_q), .level_i(hit_level), .node_i(chosen_node),
    .front_i(chosen_i.test.front), .v_i(chosen_i.test.v), .w_i(chosen_i.test.w), .det_i(chosen_i.test.det),
    .v_below_i(chosen_i.below.v), .w_below_i(chosen_i.below.w),
    .closer_o(closer),
    .divide_v_i(state_q == lod_pkg::DIVIDE_V), .divide_o,
    .divide_valid_i, .divide_what_i, .divide_i,
    .sum_i(state_q == lod_pkg::SUM),
    .map_o, .map_valid_i, .map_i,
    .hit_o(best)
  );

  // ---- Stack and split triangles ----

  logic                  push, pop, drop, stop, enough, stack_empty, stack_full;
  lod_pkg::stack_entry_t top, child_entry;
  lod_pkg::ray_error_t   push_objection;

  logic                                       stack_fault, splits_fault;
  logic [$clog2(lod_pkg::STACK_ENTRIES+1)-1:0] stack_length;

  traversal_stack #(.PARITY(MEMORY_PARITY)) u_stack (
    .clk_i, .rst_ni, .test_i(memory_test_i),
    .clear_i(setup_valid_i),
    .push_i(push), .entry_i(child_entry),
    .pop_i(pop), .entry_o(top), .empty_o(stack_empty), .full_o(stack_full),
    .length_o(stack_length), .fault_o(stack_fault)
  );

  // What would stop the context elsewhere has no part in these.
  assign push = state_q == lod_pkg::PUSH && count_q > 3'd1 && push_objection == lod_pkg::ERROR_NONE && error_q == lod_pkg::ERROR_NONE;
  assign pop  = state_q == lod_pkg::POP && !stack_empty && !enough && error_q == lod_pkg::ERROR_NONE;
  // Nothing more is wanted.
  assign enough = any && known;
  // t_near 2^18 > t_max: what is below does not matter.
  assign drop = top.t_near > t_max[lod_pkg::RAY_T_W-1:lod_pkg::T_NEAR_TO_T_SHIFT];

  // The inserted vertices that come now.
  lod_pkg::kept_point_t g0_now, g1_now, g2_now, q0_now, q1_now, q2_now;
  assign {g0_now, g1_now, g2_now} = {lod_pkg::keep_point(morph_i.g0), lod_pkg::keep_point(morph_i.g1), lod_pkg::keep_point(morph_i.g2)};
  logic [G_W-1:0] g_now;
  assign g_now = {g0_now, g1_now, g2_now};
  assign {q0_now, q1_now, q2_now} = {lod_pkg::keep_point(morph_i.q0), lod_pkg::keep_point(morph_i.q1), lod_pkg::keep_point(morph_i.q2)};

  // ---- Children ----

  logic             wrong_node;
  logic [3:0]       present;
  lod_pkg::code3_t  origin;
  logic [2:0]       halves;
  logic [2:0][3:0]  exponents;
  logic [23:0][4:0] planes;

  child_records u_children (
    .tree_i(split_there),
    .line_i(line0_q),
    .level_i(level), .node_i(node),
    .count_i(count_q), .order_i(sorted_q.order), .t_near_i(sorted_q.t_near),
    .wrong_o(wrong_node), .present_o(present), .origin_o(origin), .halves_o(halves), .exponents_o(exponents), .planes_o(planes), .entry_o(child_entry)
  );

  // ---- Requests ----

  // Long before an epoch comes again while a line of it may.
  logic rests;
  assign idle_o = state_q == lod_pkg::IDLE;
  assign rests  = idle_o && behind_q == '1 && owed_q != '0;
  assign free_o = idle_o && !rests;

  assign setup_request_o = state_q == lod_pkg::SETUP;
  lod_pkg::point_t     origin_whole;
  lod_pkg::direction_t direction_whole;
  assign origin_whole    = lod_pkg::whole_point(origin_q);
  assign direction_whole = lod_pkg::whole_direction(direction_q);
  lod_pkg::start_t start;
  assign start = {origin_whole, fraction};
  always_comb begin
    setup_o.start     = start;
    setup_o.direction = direction_whole;
  end

  assign fetch_request_o = state_q == lod_pkg::FETCH && want_q != '0 && error_q == lod_pkg::ERROR_NONE;
  assign fetch_epoch_o   = epoch_q;
  // Vertices before the split.
  assign fetch_place_o   = want_q[1] && (fetch_q == lod_pkg::SPLIT || !want_q[0]);

  // Four siblings' compact vertices have two lines, short ones one, which lie as their parents' splits do. Only nodes below a root have such.
  logic        of_siblings;
  logic [27:0] whole_node;
  assign of_siblings = fetch_place_o && compact;
  assign whole_node  = 28'(node);

  always_comb begin
    fetch_o       = '0;
    fetch_o.index = entry.index;
    case (fetch_q)
      lod_pkg::NODE: fetch_o.base = scene_i.nodes;
      lod_pkg::RECORD: begin
        fetch_o.base  = scene_i.records;
        fetch_o.scale = !compact;
        fetch_o.low   = fetch_place_o;
      end
      default: begin
        fetch_o.base  = fetch_place_o ? scene_i.vertices : scene_i.splits;
        fetch_o.place = 28'(place);
        fetch_o.level = of_siblings ? level - 4'd1 : level;
        fetch_o.index = of_siblings ? whole_node >> 2 : whole_node;
        fetch_o.scale = of_siblings && !scene_i.short_splits;
        fetch_o.low   = of_siblings && !scene_i.short_splits && whole_node[1];
        for (int unsigned k = 0; k < 9; k++) begin
          if (fetch_place_o && level == 4'(k + 1)) fetch_o.start = scene_i.vertex_starts[k];
        end
        for (int unsigned k = 0; k < 8; k++) begin
          if (!fetch_place_o && level == 4'(k + 1)) fetch_o.start = scene_i.split_starts[k];
        end
      end
    endcase
  end

  assign child_request_o = state_q == lod_pkg::CHILD && !waiting_q[0] && error_q == lod_pkg::ERROR_NONE;

  // The node's triangle as others take it.
  lod_pkg::point_t whole_f0, whole_f1, whole_f2, whole_g0, whole_g1, whole_g2, whole_p0, whole_p1, whole_p2, whole_q0, whole_q1, whole_q2;
  assign {whole_f0, whole_f1, whole_f2} = {lod_pkg::whole_point(f0), lod_pkg::whole_point(f1), lod_pkg::whole_point(f2)};
  assign {whole_g0, whole_g1, whole_g2} = {lod_pkg::whole_point(g0), lod_pkg::whole_point(g1), lod_pkg::whole_point(g2)};
  assign {whole_p0, whole_p1, whole_p2} = {lod_pkg::whole_point(p0), lod_pkg::whole_point(p1), lod_pkg::whole_point(p2)};
  assign {whole_q0, whole_q1, whole_q2} = {lod_pkg::whole_point(q0), lod_pkg::whole_point(q1), lod_pkg::whole_point(q2)};

  always_comb begin
    child_o.ray       = lod_pkg::whole_setup(setup_q);
    child_o.t_max     = t_max;
    child_o.present   = present;
    child_o.tree      = split_there;
    child_o.origin    = origin;
    child_o.halves    = halves;
    child_o.exponents = exponents;
    child_o.planes    = planes;
    child_o.f0        = whole_f0;
    child_o.f1        = whole_f1;
    child_o.f2        = whole_f2;
    child_o.g0        = whole_g0;
    child_o.g1        = whole_g1;
    child_o.g2        = whole_g2;
    child_o.p0        = whole_p0;
    child_o.p1        = whole_p1;
    child_o.p2        = whole_p2;
    child_o.q0        = whole_q0;
    child_o.q1        = whole_q1;
    child_o.q2        = whole_q2;
  end

  // The rays before this one that decide about levels around its start, and who decides here: in the tree, and about the node's edges.
  lod_pkg::ray_t            first, second;
  lod_pkg::node_deciders_out_t by;
  logic                     prior;
  if (DECIDING) begin : g_deciders
    localparam int unsigned CONE_W = lod_pkg::START_RADIUS != 0 ? lod_pkg::CONE_W : lod_pkg::CONE_W - 53;
    lod_pkg::kept_point_t     first_origin_q, second_origin_q, a0_q, a1_q, a2_q;
    lod_pkg::kept_direction_t first_direction_q, second_direction_q;
    logic [CONE_W-1:0]        first_cone_q, second_cone_q;
    logic [lod_pkg::INDEX_W-1:0] last_q;
    logic [2:0]               by_second_q;
    logic                     prior_q;
    always_ff @(posedge clk_i) begin
      if (take_i) begin
        {prior_q, by_second_q, last_q} <= {secondary_i.prior, secondary_i.by_second, lod_pkg::INDEX_W'(secondary_i.last)};
        {a0_q, a1_q, a2_q}  <= {lod_pkg::keep_point(secondary_i.a0), lod_pkg::keep_point(secondary_i.a1), lod_pkg::keep_point(secondary_i.a2)};
        first_origin_q      <= lod_pkg::keep_point(secondary_i.first.origin);
        first_direction_q   <= lod_pkg::keep_direction(secondary_i.first.direction);
        first_cone_q        <= CONE_W'(secondary_i.first.cone);
        second_origin_q     <= lod_pkg::keep_point(secondary_i.second.origin);
        second_direction_q  <= lod_pkg::keep_direction(secondary_i.second.direction);
        second_cone_q       <= CONE_W'(secondary_i.second.cone);
      end
    end
    lod_pkg::point_t a0, a1, a2;
    assign {a0, a1, a2} = {lod_pkg::whole_point(a0_q), lod_pkg::whole_point(a1_q), lod_pkg::whole_point(a2_q)};
    assign first        = {lod_pkg::whole_point(first_origin_q), lod_pkg::whole_direction(first_direction_q), lod_pkg::CONE_W'(first_cone_q)};
    assign second       = {lod_pkg::whole_point(second_origin_q), lod_pkg::whole_direction(second_direction_q), lod_pkg::CONE_W'(second_cone_q)};
    assign prior        = prior_q;
    always_comb begin
      decide_o.last   = 28'(last_q);
      decide_o.a0     = a0;
      decide_o.a1     = a1;
      decide_o.a2     = a2;
      decide_o.second = by_second_q;
      decide_o.tree   = 28'(tree_q);
      decide_o.p0     = whole_f0;
      decide_o.p1     = whole_f1;
      decide_o.p2     = whole_f2;
    end

    // None until a tree's are known; of a node they are there when it is tested.
    lod_pkg::tree_deciders_out_t tree_deciders_q;
    lod_pkg::node_deciders_in_t  node_in;
    always_ff @(posedge clk_i) begin
      if (take_i) tree_deciders_q <= '0;
      else if (decide_valid_i) tree_deciders_q <= decide_i;
    end
    always_comb begin
      node_in.tree  = decide_valid_i ? decide_i : tree_deciders_q;
      node_in.level = level;
      node_in.node  = lod_pkg::NODE_INDEX_W'(node);
    end
    node_deciders #(.TAG_W(1)) u_node_deciders (
      .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(node_in), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(by), .tag_o()
    );
  end else begin : g_no_deciders
    logic unused_deciders;
    assign {first, second, by, prior, decide_o} = '0;
    assign unused_deciders = ^{secondary_i.prior, secondary_i.last, secondary_i.a0, secondary_i.a1, secondary_i.a2, secondary_i.by_second,
                               secondary_i.first, secondary_i.second, decide_i};
  end
  assign decide_request_o = DECIDING && state_q == lod_pkg::DECIDE;

  // The cone, as far as it counts; without a choice of levels, whether the ray is of no detail.
  lod_pkg::cone_t cone;
  logic           no_detail;
  if (CHOOSING) begin : g_cone
    localparam int unsigned CONE_W = lod_pkg::START_RADIUS != 0 ? lod_pkg::CONE_W : lod_pkg::CONE_W - 53;
    logic [CONE_W-1:0] cone_q;
    always_ff @(posedge clk_i) begin
      if (take_i) cone_q <= CONE_W'(ray_i.ray.cone);
    end
    assign cone      = lod_pkg::CONE_W'(cone_q);
    assign no_detail = 1'b0;
  end else begin : g_extreme
    assign cone = '0;
    if (SPLITTING) begin : g_detail
      logic no_detail_q;
      always_ff @(posedge clk_i) begin
        if (take_i) no_detail_q <= ray_i.ray.cone.offset[52];
      end
      assign no_detail = no_detail_q;
    end else begin : g_none
      assign no_detail = 1'b1;
    end
  end

  assign lod_request_o = CHOOSING && state_q == lod_pkg::LOD;
  lod_pkg::ray_t ray;
  always_comb begin
    ray.origin    = origin_whole;
    ray.direction = direction_whole;
    ray.cone      = cone;
  end
  always_comb begin
    lod_o.ray    = ray;
    lod_o.first  = first;
    lod_o.second = second;
    lod_o.by     = by;
    lod_o.p0     = whole_p0;
    lod_o.p1     = whole_p1;
    lod_o.p2     = whole_p2;
    lod_o.e0     = e0;
    lod_o.e1     = e1;
    lod_o.e2     = e2;
    lod_o.scale  = scene_i.scale;
  end

  // It is known whether the node's triangle serves: from the LOD test, or at once.
  logic decided, refine;
  assign decided = CHOOSING ? lod_valid_i : state_q == lod_pkg::LOD;
  assign refine  = CHOOSING ? lod_i.refine : !no_detail && {e0, e1, e2} != '0;

  assign morph_request_o = state_q == lod_pkg::MORPH;

  // level < levels here.
  logic [3:0] grid;
  assign grid = scene_i.levels - level - 4'd1 + scene_i.zeros[3:0];
  // The vertices are taken out of their line outside.
  lod_pkg::tessellate_in_t morph;
  logic [3*lod_pkg::POINT_W-1:0] unused_vertices;
  always_comb begin
    morph.compact = compact;
    morph.grid    = grid;
    morph.padding = scene_i.zeros >= 5'd4 ? 3'd0 : 3'd4 - scene_i.zeros[2:0];
    morph.scale   = scene_i.scale;
    morph.e0      = e0;
    morph.e1      = e1;
    morph.e2      = e2;
    morph.s0      = lod.s0;
    morph.s1      = lod.s1;
    morph.s2      = lod.s2;
    morph.f0      = whole_f0;
    morph.f1      = whole_f1;
    morph.f2      = whole_f2;
    morph.p0      = whole_p0;
    morph.p1      = whole_p1;
    morph.p2      = whole_p2;
    morph.v0      = '0;
    morph.v1      = '0;
    morph.v2      = '0;
  end
  assign {morph_o, unused_vertices} = morph;
  // Displacements are the first in a split; of last splits two siblings share a line, or if they are short four.
  localparam int unsigned DISPLACEMENTS_W = 3 * lod_pkg::DISPLACEMENT_W;
  logic [DISPLACEMENTS_W-1:0] low_line;
  assign low_line     = vertices_in_split ? line0_q[255 -: DISPLACEMENTS_W] : line1_q[DISPLACEMENTS_W-1:0];
  assign morph_line_o = {line1_q[LINE1_W-1:DISPLACEMENTS_W], low_line};
  assign morph_short_o = compact && scene_i.short_splits && !vertices_in_split;
  assign morph_place_o = vertices_in_split ? 2'd0 : {scene_i.short_splits && node[1], node[0]};

  assign tri_request_o = state_q == lod_pkg::TRI && left_q != '0;
  assign tri_number_o  = next_q;

  // The node's triangle, or one of its children's: {p0, q2, q1}, {q2, p1, q0}, {q1, q0, p2}, {q0, q1, q2}. Chosen two by two, which is smaller than all at once.
  logic            own0, own1, own2;
  lod_pkg::point_t tested0, tested1, tested2;
  assign own0     = !four_q || next_q == 2'd0;
  assign own1     = !four_q || next_q == 2'd1;
  assign own2     = !four_q || next_q == 2'd2;
  assign tested0  = own0 ? whole_p0 : next_q[1] ? (next_q[0] ? whole_q0 : whole_q1) : whole_q2;
  assign tested1  = own1 ? whole_p1 : next_q[1] ? (next_q[0] ? whole_q1 : whole_q0) : whole_q2;
  assign tested2  = own2 ? whole_p2 : next_q[0] ? (next_q[1] ? whole_q2 : whole_q0) : whole_q1;
  always_comb begin
    tri_o.start     = start;
    tri_o.direction = direction_whole;
    tri_o.p0        = tested0;
    tri_o.p1        = tested1;
    tri_o.p2        = tested2;
  end

  // The corners of the closest hit, chosen likewise.
  if (SECONDARY) begin : g_corners
    logic                 met0, met1, met2;
    lod_pkg::kept_point_t corner0_q, corner1_q, corner2_q;
    assign met0 = !four_q || chosen_i.number == 2'd0;
    assign met1 = !four_q || chosen_i.number == 2'd1;
    assign met2 = !four_q || chosen_i.number == 2'd2;
    always_ff @(posedge clk_i) begin
      if (closer) begin
        corner0_q <= met0 ? p0 : chosen_i.number[1] ? (chosen_i.number[0] ? q0 : q1) : q2;
        corner1_q <= met1 ? p1 : chosen_i.number[1] ? (chosen_i.number[0] ? q1 : q0) : q2;
        corner2_q <= met2 ? p2 : chosen_i.number[0] ? (chosen_i.number[1] ? q2 : q0) : q1;
      end
    end
    assign corners_o = {lod_pkg::whole_point(corner0_q), lod_pkg::whole_point(corner1_q), lod_pkg::whole_point(corner2_q)};
  end else begin : g_no_corners
    logic unused_closer;
    assign corners_o     = '0;
    assign unused_closer = closer;
  end

  always_comb begin
    select_o.levels     = scene_i.levels;
    select_o.known      = known;
    select_o.best_t     = t_max;
    select_o.best_front = best.front;
    select_o.best_id    = best_id;
    select_o.t          = hit_t_i;
    select_o.front      = hit_front_i;
    select_o.tree       = 28'(tree_q);
    select_o.level      = hit_level;
    select_o.node       = lod_pkg::NODE_INDEX_W'(hit_node);
  end

  assign divide_request_o = state_q == lod_pkg::DIVIDE_V || state_q == lod_pkg::DIVIDE_W;
  assign divide_what_o    = (state_q == lod_pkg::DIVIDE_V) ? lod_pkg::DIVIDE_FOR_V : lod_pkg::DIVIDE_FOR_W;
  assign map_request_o = MAPPING && state_q == lod_pkg::MAP;
  assign hit_request_o = state_q == lod_pkg::DONE;

  always_comb begin
    hit_o.tag   = tag_q;
    hit_o.error = error_q;
    hit_o.found = known && error_q == lod_pkg::ERROR_NONE;
    hit_o.hit   = best;
  end

  // ---- What ends a ray early ----

  logic record_there;
  assign record_there = want_q == '0 && waiting_q == '0;

  // An L0 record that no scene of this configuration has: deeper, with a place beyond the bits that are kept of it, or with corners where there is none.
  logic too_deep, place_beyond, wrong_record, misplaced_q;
  assign too_deep     = record.depth > scene_i.levels || record.depth > 4'(lod_pkg::STORED_LEVELS);
  assign place_beyond = record.depth != '0 && record.place >> lod_pkg::INDEX_W != '0;
  assign wrong_record = too_deep || place_beyond || misplaced_q;

  // Inserted vertices likewise; a displacement can lead anywhere.
  logic wrong_vertices;
  assign wrong_vertices = morph_beyond_i || (morph_bits_i & ~(16'hFFFF << grid)) != '0;

  // What the context cannot do in this cycle.
  lod_pkg::ray_error_t objection;
  always_comb begin
    push_objection = lod_pkg::ERROR_NONE;
    if (count_q != '0 && child_entry.index >> lod_pkg::INDEX_W != '0) push_objection = lod_pkg::ERROR_IMAGE;
    else if (count_q > 3'd1 && stack_full) push_objection = lod_pkg::ERROR_STACK;
  end
  always_comb begin
    objection = lod_pkg::ERROR_NONE;
    case (state_q)
      lod_pkg::VISIT:      if (visits_q == '0) objection = lod_pkg::ERROR_VISITS;
      lod_pkg::FETCH: begin
        if (record_there && (fetch_q == lod_pkg::NODE && wrong_node || fetch_q == lod_pkg::RECORD && wrong_record)) objection = lod_pkg::ERROR_IMAGE;
      end
      lod_pkg::MORPH_WAIT: if (morph_valid_i && wrong_vertices) objection = lod_pkg::ERROR_IMAGE;
      lod_pkg::PUSH:       objection = push_objection;
      default:             ;
    endcase
  end

  // An error is acted upon where the context waits for no block, so that each of a block's results has its context.
  logic waits_for_no_block;
  always_comb begin
    case (state_q)
      lod_pkg::VISIT, lod_pkg::FETCH, lod_pkg::CHILD, lod_pkg::PUSH, lod_pkg::POP: waits_for_no_block = 1'b1;
      default:                                                                     waits_for_no_block = 1'b0;
    endcase
  end
  assign stop = objection != lod_pkg::ERROR_NONE || (error_q != lod_pkg::ERROR_NONE && waits_for_no_block);

  // Lines that come, and whether nothing moves while they are waited for.
  logic [1:0] granted, arrived;
  logic       idles;
  assign granted = fetch_grant_i ? 2'b01 << fetch_place_o : 2'b00;
  assign arrived = line_valid_i && line_i.epoch == epoch_q && !line_i.tag[1] ? (2'b01 << line_i.tag[0]) & waiting_q : 2'b00;
  assign idles   = !record_there && granted == '0 && arrived == '0;

  lod_pkg::ray_error_t error_taken;
  assign error_taken = flush_i ? lod_pkg::ERROR_ABORTED : fits_i ? lod_pkg::ERROR_NONE : lod_pkg::ERROR_SCENE;

  // The first one stays.
  always_ff @(posedge clk_i) begin
    if (take_i) error_q <= error_taken;
    else if (error_q == lod_pkg::ERROR_NONE && state_q != lod_pkg::IDLE && state_q != lod_pkg::DONE) begin
      if (flush_i) error_q <= lod_pkg::ERROR_ABORTED;
      else if (arrived != '0 && line_i.error) error_q <= lod_pkg::ERROR_MEMORY;
      else if (idles && tick_i && stale_q) error_q <= lod_pkg::ERROR_LATE;
      else error_q <= objection;
    end
    stale_q <= idles && (tick_i || stale_q);
    if (setup_valid_i) visits_q <= scene_i.visits;
    else if (state_q == lod_pkg::VISIT) visits_q <= visits_q - 32'd1;
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      epoch_q  <= '0;
      behind_q <= '0;
    end else if (setup_valid_i) begin
      epoch_q  <= epoch_q + lod_pkg::EPOCH_W'(1);
      behind_q <= owed_q == '0 ? '0 : behind_q + lod_pkg::BEHIND_W'(1);
    end
  end

  // Every line is owed until it comes, late or not. What has not come in an age of rest is given up: it never comes, or the memory broke its rule.
  logic gives_up;
  assign gives_up = rests && age_i && rested_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni || gives_up) owed_q <= '0;
    else owed_q <= owed_q + lod_pkg::OWED_W'(fetch_grant_i) - lod_pkg::OWED_W'(line_valid_i && owed_q != '0);
    rested_q <= rests && (age_i || rested_q);
  end

  // The unit's alone.
  logic unused_limit;
  assign unused_limit = ^scene_i.answer_limit;

  // ---- Steps: the next state, and what else a state does ----

  // Lines are wanted from the next cycle on, and for what. A child is visited, not pushed; an entry is left for its node. A tree is entered, or a node of one. The triangles of a node, or its own,
  // are tested from the next cycle on: what stops the context late has no part in it, as then they are not.
  logic            want, visit_child, enter_root, enter_node, enter_tri, enter_four;
  logic [1:0]      wanted;
  lod_pkg::fetch_t fetched_for;
  always_comb begin
    state_d     = state_q;
    want        = 1'b0;
    wanted      = 2'b01;
    fetched_for = lod_pkg::NODE;
    visit_child = 1'b0;
    enter_root  = 1'b0;
    enter_node  = 1'b0;
    enter_tri   = 1'b0;
    enter_four  = 1'b0;
    case (state_q)
      lod_pkg::IDLE:       if (take_i) state_d = (error_taken == lod_pkg::ERROR_NONE) ? lod_pkg::SETUP : lod_pkg::DONE;
      lod_pkg::SETUP:      if (setup_grant_i) state_d = lod_pkg::SETUP_WAIT;
      lod_pkg::SETUP_WAIT: if (setup_valid_i) state_d = lod_pkg::VISIT;
      lod_pkg::VISIT: begin
        state_d = lod_pkg::FETCH;
        case (entry.kind)
          lod_pkg::ENTRY_BVH_NODE: want = 1'b1;
          lod_pkg::ENTRY_TREE: begin
            want        = 1'b1;
            wanted      = compact ? 2'b01 : 2'b11;
            fetched_for = lod_pkg::RECORD;
          end
          lod_pkg::ENTRY_TREE_NODE: begin
            state_d    = lod_pkg::LOD;
            enter_node = 1'b1;
          end
          default: ;
        endcase
      end
      lod_pkg::FETCH: begin
        case (fetch_q)
          lod_pkg::NODE:   if (record_there) state_d = lod_pkg::CHILD;
          lod_pkg::RECORD: if (record_there) begin
            state_d    = (record.depth == '0) ? lod_pkg::TRI : DECIDING && prior ? lod_pkg::DECIDE : lod_pkg::LOD;
            enter_root = 1'b1;
            enter_tri  = record.depth == '0;
          end
          // SPLIT: it may still be under way where the vertices are elsewhere.
          default:         if (want_q == '0 && !waiting_q[1] && !(compact && waiting_q[0])) state_d = lod_pkg::MORPH;
        endcase
      end
      lod_pkg::CHILD:      if (child_grant_i) state_d = lod_pkg::CHILD_WAIT;
      lod_pkg::CHILD_WAIT: if (child_valid_i) state_d = lod_pkg::PUSH;
      lod_pkg::PUSH: begin
        visit_child = count_q == 3'd1;
        if (visit_child) state_d = lod_pkg::VISIT;
        else if (count_q == 3'd0) state_d = lod_pkg::POP;
      end
      lod_pkg::POP: begin
        if (stack_empty || enough) state_d = known ? lod_pkg::DIVIDE_V : lod_pkg::DONE;
        else if (!drop) state_d = lod_pkg::VISIT;
      end
      lod_pkg::DECIDE:      if (decide_grant_i) state_d = lod_pkg::DECIDE_WAIT;
      lod_pkg::DECIDE_WAIT: if (decide_valid_i) state_d = lod_pkg::LOD;
      lod_pkg::LOD, lod_pkg::LOD_WAIT: begin
        if (decided && refine) begin
          state_d     = lod_pkg::FETCH;
          want        = 1'b1;
          wanted      = vertices_in_split ? 2'b01 : last_split ? 2'b10 : 2'b11;
          fetched_for = lod_pkg::SPLIT;
        end else if (decided) begin
          state_d   = lod_pkg::TRI;
          enter_tri = 1'b1;
        end else if (lod_grant_i) state_d = lod_pkg::LOD_WAIT;
      end
      lod_pkg::MORPH:       if (morph_grant_i) state_d = lod_pkg::MORPH_WAIT;
      lod_pkg::MORPH_WAIT:  if (morph_valid_i) begin
        state_d    = last_split ? lod_pkg::TRI : lod_pkg::CHILD;
        enter_tri  = last_split;
        enter_four = last_split;
      end
      lod_pkg::TRI:         if (left_q == '0 && pending_q == '0) state_d = lod_pkg::POP;
      lod_pkg::DIVIDE_V:    if (divide_grant_i) state_d = lod_pkg::DIVIDE_W;
      lod_pkg::DIVIDE_W:    if (divide_grant_i) state_d = lod_pkg::DIVIDE_WAIT;
      lod_pkg::DIVIDE_WAIT: if (divide_valid_i && divide_what_i == lod_pkg::DIVIDE_FOR_W) state_d = lod_pkg::SUM;
      lod_pkg::SUM:         state_d = MAPPING ? lod_pkg::MAP : lod_pkg::DONE;
      lod_pkg::MAP:         if (map_grant_i) state_d = lod_pkg::MAP_WAIT;
      lod_pkg::MAP_WAIT:    if (map_valid_i) state_d = lod_pkg::DONE;
      lod_pkg::DONE:        if (hit_grant_i) state_d = lod_pkg::IDLE;
      default:              state_d = lod_pkg::IDLE;
    endcase
    if (stop) state_d = lod_pkg::DONE;
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) state_q <= lod_pkg::IDLE;
    else state_q <= state_d;
  end

  // ---- Ray ----

  always_ff @(posedge clk_i) begin
    if (take_i) begin
      tag_q       <= ray_i.tag;
      origin_q    <= lod_pkg::keep_point(ray_i.ray.origin);
      direction_q <= lod_pkg::keep_direction(ray_i.ray.direction);
    end
    if (setup_valid_i) setup_q <= lod_pkg::keep_setup(setup_i);
  end

  // ---- Entry, node and triangle ----

  // The line with its corners comes.
  logic corners_come, root_comes;
  assign corners_come = compact ? arrived[0] : arrived[1];
  assign root_comes   = state_q == lod_pkg::FETCH && fetch_q == lod_pkg::RECORD && corners_come;

  // A tree's entry with the bound codes that only its record has.
  lod_pkg::stack_entry_t root_entry;
  always_comb begin
    root_entry = entry;
    {root_entry.e0, root_entry.e1, root_entry.e2} = {record.e0, record.e1, record.e2};
  end

  always_ff @(posedge clk_i) begin
    if (setup_valid_i) entry_q <= '0;
    else if (visit_child) entry_q <= lod_pkg::keep_entry(child_entry);
    else if (pop && !drop) entry_q <= lod_pkg::keep_entry(top);
    else if (enter_root) entry_q <= lod_pkg::keep_entry(root_entry);
  end

  always_ff @(posedge clk_i) begin
    if (want && fetched_for == lod_pkg::RECORD) tree_q <= lod_pkg::INDEX_W'(entry.index);
  end

  // Its triangle, at full resolution (f) and as morphed (p): a root's as it is.
  if (SPLITS > 0) begin : g_splits
    lod_pkg::kept_point_t  root0_now, root1_now, root2_now;
    logic [3*CORNER_W-1:0] roots_now, inserted_now, node_corners;

    // A root's corners go to the memory as they come, so that they can be read when the whole record is there.
    assign {root2_now, root1_now, root0_now} = line_corners_i;

    if (CHOOSING) begin : g_both
      assign roots_now    = {root2_now, root2_now, root1_now, root1_now, root0_now, root0_now};
      assign inserted_now = {g2_now, q2_now, g1_now, q1_now, g0_now, q0_now};
      assign {f2, p2, f1, p1, f0, p0} = node_corners;
    end else begin : g_full
      assign roots_now    = {root2_now, root1_now, root0_now};
      assign inserted_now = {g2_now, g1_now, g0_now};
      assign {f2, f1, f0} = node_corners;
      assign {p2, p1, p0} = node_corners;
    end

    split_triangles #(.W(CORNER_W), .LEVELS(SPLITS), .PARITY(MEMORY_PARITY)) u_splits (
      .clk_i, .rst_ni, .test_i(memory_test_i),
      .root_write_i(root_comes), .root_corners_i(roots_now),
      .corners_write_i(morph_grant_i && !last_split), .inserted_write_i(morph_valid_i && !last_split), .level_i(level), .inserted_i(inserted_now),
      .read_i(enter_root || enter_node), .root_i(enter_root), .parent_i(entry.level - 4'd1),
      .child_i(entry.kind == lod_pkg::ENTRY_TREE_NODE ? entry.index[1:0] : 2'd3), .corners_o(node_corners), .fault_o(splits_fault)
    );
  end else begin : g_no_splits
    // There are roots alone.
    logic                 unused_node;
    lod_pkg::kept_point_t f0_q, f1_q, f2_q;
    assign unused_node = ^{enter_root, enter_node};
    assign splits_fault = 1'b0;
    always_ff @(posedge clk_i) begin
      if (root_comes) {f2_q, f1_q, f0_q} <= line_corners_i;
    end
    assign {f0, f1, f2} = {f0_q, f1_q, f2_q};
    assign {p0, p1, p2} = {f0_q, f1_q, f2_q};
  end

  // Level, node, bound codes and what else only trees with splits have. A root has level and node 0, and its record's codes; a node those of its entry.
  if (SPLITTING) begin : g_place
    logic [lod_pkg::INDEX_W-1:0] place_q;
    logic [3:0]                  depth_q;

    always_ff @(posedge clk_i) begin
      if (enter_root) {depth_q, place_q} <= {record.depth, lod_pkg::INDEX_W'(record.place)};
    end
    assign {depth, place} = {depth_q, place_q};

    // An entry is kept with its codes where trees have nodes: those of a root take the place of its own, which are 0.
    if (SPLITS > 0) begin : g_nodes
      // Nodes of a tree are below 4^STORED_LEVELS.
      assign {level, node} = entry.kind == lod_pkg::ENTRY_TREE_NODE ? {entry.level, NODE_W'(entry.index)} : '0;
      assign {e0, e1, e2}  = {entry.e0, entry.e1, entry.e2};
    end else begin : g_root
      logic [lod_pkg::BOUND_CODE_W-1:0] e0_q, e1_q, e2_q;
      always_ff @(posedge clk_i) begin
        if (enter_root) {e0_q, e1_q, e2_q} <= {record.e0, record.e1, record.e2};
      end
      assign {level, node} = '0;
      assign {e0, e1, e2}  = {e0_q, e1_q, e2_q};
    end

    // Inserted vertices at full resolution: what the line has no room for.
    if (G_W > LINE1_W) begin : g_rest
      logic [G_W-LINE1_W-1:0] rest_q;
      always_ff @(posedge clk_i) begin
        if (morph_valid_i) rest_q <= g_now[G_W-1:LINE1_W];
      end
      assign {g0, g1, g2} = {rest_q, line1_q};
    end else begin : g_all
      assign {g0, g1, g2} = line1_q[G_W-1:0];
    end
  end else begin : g_base
    logic unused_split;
    assign {depth, place, level, node} = '0;
    assign {e0, e1, e2, g0, g1, g2}    = '0;
    assign unused_split                = ^g_now;
  end

  // The inserted vertices as morphed, and the states of the triangle's edges.
  if (CHOOSING) begin : g_morphed
    lod_pkg::kept_point_t   q0_q, q1_q, q2_q;
    lod_pkg::lod_test_out_t lod_q;

    always_ff @(posedge clk_i) begin
      if (lod_valid_i) lod_q <= lod_i;
      if (morph_valid_i) {q0_q, q1_q, q2_q} <= {q0_now, q1_now, q2_now};
    end
    assign {q0, q1, q2} = {q0_q, q1_q, q2_q};
    assign lod          = lod_q;
  end else begin : g_full
    logic unused_morphed;
    assign {q0, q1, q2}   = {g0, g1, g2};
    assign lod            = '0;
    assign unused_morphed = ^{q0_now, q1_now, q2_now, lod_i};
  end

  // ---- Lines ----

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      want_q    <= '0;
      waiting_q <= '0;
    end else if (take_i) begin
      // What the ray before still waited for comes too late, if at all.
      want_q    <= '0;
      waiting_q <= '0;
    end else begin
      waiting_q <= (waiting_q | granted) & ~arrived;
      if (want) want_q <= wanted;
      else want_q <= want_q & ~granted;
    end
  end

  always_ff @(posedge clk_i) begin
    if (arrived[0]) line0_q <= line_i.line;
    if (corners_come) misplaced_q <= line_misplaced_i;
    // Vertices come before `tessellate` is asked.
    if (arrived[1]) line1_q <= LINE1_W'(line_i.line);
    else if (SPLITTING && morph_valid_i) line1_q <= LINE1_W'(g_now);
    if (want) fetch_q <= fetched_for;
  end

  // ---- Children and triangles ----

  always_ff @(posedge clk_i) begin
    if (child_valid_i) begin
      sorted_q <= child_i;
      count_q  <= child_i.count;
    end else if (push) count_q <= count_q - 3'd1;
  end

  always_ff @(posedge clk_i) begin
    if (enter_tri) begin
      four_q    <= enter_four;
      left_q    <= enter_four ? 3'd4 : 3'd1;
      next_q    <= '0;
      pending_q <= '0;
    end else begin
      if (tri_grant_i) begin
        left_q <= left_q - 3'd1;
        next_q <= next_q + 2'd1;
      end
      pending_q <= pending_q + 3'(tri_grant_i) - 3'(tri_miss_i) - 3'(select_valid_i);
    end
  end

  // ---- What it is doing ----

  if (WATCH) begin : g_view
    // Behind its setup a ray has an entry under visit, unless it ended before.
    logic has_entry;
    assign has_entry = state_q > lod_pkg::SETUP_WAIT && state_q != lod_pkg::DONE;

    always_comb begin
      view_o         = '0;
      view_o.state   = state_q;
      view_o.rests   = rests;
      view_o.epoch   = epoch_q;
      view_o.owed    = owed_q;
      view_o.stacked = 7'(stack_length);
      if (!idle_o) begin
        view_o.tag   = tag_q;
        view_o.error = error_q;
      end
      if (has_entry) begin
        view_o.kind    = entry.kind;
        view_o.level   = entry.level;
        view_o.index   = entry.index;
        view_o.visits  = visits_q;
        view_o.want    = want_q;
        view_o.waiting = waiting_q;
      end
      if (state_q == lod_pkg::TRI) begin
        view_o.left    = left_q;
        view_o.pending = pending_q;
      end
    end
  end else begin : g_no_view
    logic unused_length;
    assign unused_length = ^stack_length;
    assign view_o        = '0;
  end

  assign fault_o = stack_fault || splits_fault;

endmodule

`default_nettype wire
