  // Inside ray_context: in every state it waits for what it has asked for and has not got, and asks for no more than there is room for.
  logic       live, v_inside, w_inside;
  logic [5:0] inside;
  logic [1:0] asked;
  logic [2:0] tested;
  logic [3:0] numbers;
  context_rules #(.OF_CONTEXT(1)) u_rules (
    .clk_i, .rst_ni, .idle_i(idle_o), .free_i(free_o), .take_i,
    .request_i({decide_request_o, setup_request_o, child_request_o, lod_request_o, morph_request_o, map_request_o}),
    .grant_i({decide_grant_i, setup_grant_i, child_grant_i, lod_grant_i, morph_grant_i, map_grant_i}),
    .valid_i({decide_valid_i, setup_valid_i, child_valid_i, lod_valid_i, morph_valid_i, map_valid_i}),
    .line_request_i(fetch_request_o), .line_place_i(fetch_place_o), .epoch_i(fetch_epoch_o), .line_grant_i(fetch_grant_i),
    .line_valid_i, .line_valid_place_i(line_i.tag[1:0]), .line_valid_epoch_i(line_i.epoch),
    .tri_request_i(tri_request_o), .tri_number_i(tri_number_o), .tri_grant_i, .tri_miss_i, .select_valid_i,
    .divide_request_i(divide_request_o), .divide_what_i(divide_what_o), .divide_grant_i, .divide_valid_i, .divide_valid_what_i(divide_what_i),
    .hit_request_i(hit_request_o), .hit_grant_i,
    .live_o(live), .inside_o(inside), .asked_o(asked), .tested_o(tested), .numbers_o(numbers), .v_o(v_inside), .w_o(w_inside)
  );

  // States that no ray comes to are none: the machine goes through these alone.
  logic traverses, finishes;
  assign traverses = state_q >= lod_pkg::VISIT && state_q <= lod_pkg::TRI;
  assign finishes  = state_q >= lod_pkg::DIVIDE_V && state_q <= lod_pkg::DONE;

  // A split is fetched, or vertices; and a split with vertices elsewhere.
  logic of_split, with_split;
  assign of_split   = fetch_q != lod_pkg::NODE && fetch_q != lod_pkg::RECORD;
  assign with_split = of_split && !last_split && !compact;

  logic [2:0] all, sent;
  assign all  = four_q ? 3'd4 : 3'd1;
  assign sent = all - left_q;

  // The scene stands still while a ray is under way.
  lod_pkg::scene_config_t scene_q;
  always_ff @(posedge clk_i) scene_q <= scene_i;
  always_comb assume (idle_o || scene_i == scene_q);
  // Before the first reset nothing comes.
  always_comb assume (live || (!morph_grant_i && !morph_valid_i && !line_valid_i));

  // What the stack read last is its top again before anything is popped.
  (* hierconn *) logic \u_stack.stale_q ;

  always_comb begin
    if (live) begin
      assert (state_q <= lod_pkg::DONE);
      // Nobody decides for a ray where no ray starts on a surface.
      assert (DECIDING || (state_q != lod_pkg::DECIDE && state_q != lod_pkg::DECIDE_WAIT));
      assert (!\u_stack.stale_q  || state_q == lod_pkg::PUSH || state_q == lod_pkg::VISIT || state_q == lod_pkg::DONE || state_q == lod_pkg::IDLE);
      // Who waits for a block's result has its one operation there, and nobody else has.
      assert (inside == {state_q == lod_pkg::DECIDE_WAIT, state_q == lod_pkg::SETUP_WAIT, state_q == lod_pkg::CHILD_WAIT, state_q == lod_pkg::LOD_WAIT, state_q == lod_pkg::MORPH_WAIT, state_q == lod_pkg::MAP_WAIT});
      // Triangles: a node's one or its children's four are sent, in turn, or still to be sent; those sent have a verdict or are waited for.
      assert (tested == (state_q == lod_pkg::TRI ? pending_q : 3'd0));
      if (state_q == lod_pkg::TRI) begin
        assert (left_q <= all && 3'(next_q) == (sent & 3'd3) && tested <= sent);
        assert (tested == '0 || numbers >> sent == '0);
      end
      // Divisions.
      assert (!v_inside || state_q == lod_pkg::DIVIDE_W || state_q == lod_pkg::DIVIDE_WAIT);
      assert (w_inside == (state_q == lod_pkg::DIVIDE_WAIT));
      // Lines: those waited for are those that this ray asked for and has not got, each once; none is wanted that is waited for.
      if (traverses) assert (waiting_q == asked && (want_q & waiting_q) == '0);
      // They are fetched in FETCH, but a split whose vertices are elsewhere comes as late as CHILD.
      if (state_q <= lod_pkg::TRI && state_q != lod_pkg::IDLE) begin
        assert (want_q == '0 || state_q == lod_pkg::FETCH);
        assert (!waiting_q[1] || state_q == lod_pkg::FETCH);
        assert (!waiting_q[0] || state_q == lod_pkg::FETCH || ((state_q == lod_pkg::MORPH || state_q == lod_pkg::MORPH_WAIT || state_q == lod_pkg::CHILD) && with_split));
        assert (!(state_q == lod_pkg::FETCH && of_split && (want_q[0] || waiting_q[0])) || with_split || vertices_in_split);
        assert (!(state_q == lod_pkg::FETCH && of_split && (want_q[1] || waiting_q[1])) || !vertices_in_split);
      end
    end
    cover (live && state_q == lod_pkg::FETCH && error_q == lod_pkg::ERROR_LATE && asked == 2'b01);
    cover (live && state_q == lod_pkg::CHILD && child_grant_i);
  end
