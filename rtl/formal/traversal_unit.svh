  // Inside traversal_unit, its contexts and blocks free but for what each keeps to: results go to whom they are for, and no queue overflows.
  logic [N-1:0] live, v_inside, w_inside;
  logic [N-1:0][5:0] inside;
  logic [N-1:0][2:0] tested;
  logic [N-1:0][3:0] numbers;

  // The rules stand at the same wires as the ports of the contexts, which are free here. The contexts' side is what `ray_context_waits` proves of each.
  for (genvar k = 0; k < N; k++) begin : g_rules
    localparam logic [CONTEXT_W-1:0] ME = CONTEXT_W'(k);
    context_rules #(.OF_CONTEXT(0)) u_rules (
      .clk_i, .rst_ni, .idle_i(idle[k]), .free_i(free[k]), .take_i(take[k]),
      .request_i({decide_request[k], setup_request[k], child_request[k], lod_request[k], morph_request[k], map_request[k]}),
      .grant_i({decide_grant[k], setup_grant[k], child_grant[k], lod_grant[k], morph_grant[k], map_grant[k]}),
      .valid_i({decide_for[k], setup_for[k], child_for[k], lod_for[k], morph_for[k], map_for[k]}),
      .line_request_i(fetch_request[k]), .line_place_i(fetch_data[k][FETCH_W-1]), .epoch_i(fetch_data[k][FETCH_W-2 -: lod_pkg::EPOCH_W]), .line_grant_i(fetch_grant[k]),
      .line_valid_i(mem_valid_i && mem_i.tag[7:2] == 6'(ME)), .line_valid_place_i(mem_i.tag[1:0]), .line_valid_epoch_i(mem_i.epoch),
      .tri_request_i(tri_request[k]), .tri_number_i(tri_data[k][TRI_W-1:TRI_W-2]), .tri_grant_i(tri_grant[k]),
      .tri_miss_i(tri_valid && !tri_out.hit && tri_owner == ME), .select_valid_i(select_valid && select_owner == ME),
      .divide_request_i(divide_request[k]), .divide_what_i(divide_data[k][DIVIDE_W-1:DIVIDE_W-2]), .divide_grant_i(divide_grant[k]),
      .divide_valid_i(divide_valid && divide_owner == ME), .divide_valid_what_i(divide_what),
      .hit_request_i(hit_request[k]), .hit_grant_i(hit_grant[k]),
      .live_o(live[k]), .inside_o(inside[k]), .asked_o(), .tested_o(tested[k]), .numbers_o(numbers[k]), .v_o(v_inside[k]), .w_o(w_inside[k])
    );
  end

  // Blocks of which each context has one operation at most, and tri_test. Of two contexts, the one that a result is for.
  logic setup_given, child_given, lod_given, morph_given, map_given;
  logic [CONTEXT_W-1:0] setup_owner, child_owner, lod_owner, morph_owner, map_owner;
  assign {setup_given, child_given, lod_given, morph_given, map_given} = {setup_for != '0, child_for != '0, lod_for != '0, morph_for != '0, map_for != '0};
  assign {setup_owner, child_owner, lod_owner, morph_owner, map_owner} = {CONTEXT_W'(setup_for[1]), CONTEXT_W'(child_for[1]), CONTEXT_W'(lod_for[1]), CONTEXT_W'(morph_for[1]), CONTEXT_W'(map_for[1])};
  logic [N-1:0] in_setup, in_child, in_lod, in_morph, in_map;
  logic [N-1:0][3:0] in_tri;
  tagged_block #(.TAGS(N)) u_in_setup (.clk_i, .rst_ni, .live_i(live[0]), .take_i(setup_in_valid && setup_in_ready), .take_tag_i(setup_in_tag), .give_i(setup_given), .give_tag_i(setup_owner), .inside_o(in_setup));
  tagged_block #(.TAGS(N)) u_in_child (.clk_i, .rst_ni, .live_i(live[0]), .take_i(child_in_valid && child_in_ready), .take_tag_i(child_in_tag), .give_i(child_given), .give_tag_i(child_owner), .inside_o(in_child));
  tagged_block #(.TAGS(N)) u_in_lod (.clk_i, .rst_ni, .live_i(live[0]), .take_i(lod_in_valid && lod_in_ready), .take_tag_i(lod_in_tag), .give_i(lod_given), .give_tag_i(lod_owner), .inside_o(in_lod));
  tagged_block #(.TAGS(N)) u_in_morph (.clk_i, .rst_ni, .live_i(live[0]), .take_i(morph_in_valid && morph_in_ready), .take_tag_i(morph_in_tag), .give_i(morph_given), .give_tag_i(morph_owner), .inside_o(in_morph));
  tagged_block #(.TAGS(N)) u_in_map (.clk_i, .rst_ni, .live_i(live[0]), .take_i(map_in_valid && map_in_ready), .take_tag_i(map_in_tag), .give_i(map_given), .give_tag_i(map_owner), .inside_o(in_map));
  tagged_block #(.TAGS(4 * N), .TAG_W(CONTEXT_W + 2)) u_in_tri (
    .clk_i, .rst_ni, .live_i(live[0]), .take_i(tri_in_valid && tri_in_ready), .take_tag_i({tri_in_tag, tri_in_number}), .give_i(tri_valid), .give_tag_i({tri_owner, tri_number}), .inside_o(in_tri)
  );

  // Hits in the queue, in the division and in hit_select.
  localparam int unsigned PLACES = 4 * N;
  localparam int unsigned PLACE_W = $clog2(PLACES);
  (* hierconn *) logic [PLACES-1:0][lod_pkg::KEPT_HIT_W-1:0] \u_queue.u_items.words ;
  (* hierconn *) logic [PLACE_W-1:0] \u_queue.head_q , \u_queue.tail_q ;
  (* hierconn *) logic [$clog2(PLACES+1)-1:0] \u_queue.len_q ;
  (* hierconn *) logic \u_divide.g_copy[0].g_hit_divide.u_hit_divide.busy_q ;
  (* hierconn *) logic [lod_pkg::DIVIDE_TAG_W-1:0] \u_divide.g_copy[0].g_hit_divide.u_hit_divide.tag_q ;
  (* hierconn *) logic [$clog2(lod_pkg::HIT_DIVIDE_LATENCY)-1:0] \u_divide.g_copy[0].g_hit_divide.u_hit_divide.steps_left_q ;
  (* hierconn *) logic \u_hit_select.valid_tree , \u_hit_select.valid_id ;
  (* hierconn *) logic [CONTEXT_W-1:0] \u_hit_select.tag_tree , \u_hit_select.tag_id ;

  logic [1:0]           dividing_what;
  logic [CONTEXT_W-1:0] dividing_owner;
  logic [1:0]           dividing_number;
  assign {dividing_what, dividing_owner, dividing_number} = \u_divide.g_copy[0].g_hit_divide.u_hit_divide.tag_q ;

  lod_pkg::queued_hit_t waiting;
  (* hierconn *) logic [0:0][lod_pkg::KEPT_HIT_W-1:0] \u_divide.with_q ;
  assign waiting = lod_pkg::QUEUED_HIT_W'(\u_divide.with_q [0]);

  int unsigned steps_left;
  assign steps_left = \u_divide.g_copy[0].g_hit_divide.u_hit_divide.busy_q ? 32'(\u_divide.g_copy[0].g_hit_divide.u_hit_divide.steps_left_q ) : 32'd100;

  // Cycles since a tick.
  logic [lod_pkg::ANSWER_LIMIT_W-1:0] since_q;
  always_ff @(posedge clk_i) since_q <= !rst_ni || tick ? '0 : since_q + lod_pkg::ANSWER_LIMIT_W'(1);

  // Triangles of each context without a verdict, wherever they are.
  logic [N-1:0][7:0]  somewhere;
  logic [N-1:0][7:0]  queued;
  logic [7:0]         in_queue;
  logic               owners_known;
  lod_pkg::queued_hit_t item;
  always_comb begin
    owners_known = 1'b1;
    queued       = '0;
    in_queue     = '0;
    item         = '0;
    for (int unsigned i = 0; i < PLACES; i++) begin
      item = lod_pkg::QUEUED_HIT_W'(\u_queue.u_items.words [i]);
      if (32'(PLACE_W'(PLACE_W'(i) - \u_queue.head_q )) < 32'(\u_queue.len_q )) begin
        if (32'(item.owner) >= N) owners_known = 1'b0;
        for (int unsigned k = 0; k < N; k++) if (32'(item.owner) == k) queued[k] = queued[k] + 8'd1;
      end
    end
    for (int unsigned k = 0; k < N; k++) in_queue = in_queue + queued[k];
    for (int unsigned k = 0; k < N; k++) begin
      somewhere[k] = 8'(in_tri[k][0]) + 8'(in_tri[k][1]) + 8'(in_tri[k][2]) + 8'(in_tri[k][3]) + 8'(queued[k])
                   + 8'(\u_divide.g_copy[0].g_hit_divide.u_hit_divide.busy_q && dividing_what == lod_pkg::DIVIDE_FOR_T && 32'(dividing_owner) == k)
                   + 8'(\u_hit_select.valid_tree && 32'(\u_hit_select.tag_tree ) == k) + 8'(\u_hit_select.valid_id && 32'(\u_hit_select.tag_id ) == k) + 8'(select_valid && 32'(select_owner) == k);
    end
  end

  always_comb begin
    if (live[0]) begin
      assert (owners_known && 32'(\u_queue.len_q ) <= PLACES && \u_queue.tail_q == PLACE_W'(\u_queue.head_q + \u_queue.len_q ));
      assert (32'(\u_queue.len_q ) == 32'(in_queue));
      assert (queue_empty || kept_head == \u_queue.u_items.words [\u_queue.head_q ]);
      // What the contexts count is what the blocks have.
      for (int unsigned k = 0; k < N; k++) begin
        assert (inside[k] == {1'b0, in_setup[k], in_child[k], in_lod[k], in_morph[k], in_map[k]});
        assert (8'(tested[k]) == somewhere[k]);
        assert ((in_tri[k] & ~numbers[k]) == '0);
        assert (v_inside[k] == (\u_divide.g_copy[0].g_hit_divide.u_hit_divide.busy_q && dividing_what == lod_pkg::DIVIDE_FOR_V && 32'(dividing_owner) == k));
        assert (w_inside[k] == (\u_divide.g_copy[0].g_hit_divide.u_hit_divide.busy_q && dividing_what == lod_pkg::DIVIDE_FOR_W && 32'(dividing_owner) == k));
      end
      // The numerators that a context takes with a comparison are those of its hit: the next one comes later.
      assert (!(\u_divide.g_copy[0].g_hit_divide.u_hit_divide.busy_q && dividing_what == lod_pkg::DIVIDE_FOR_T) || (waiting.owner == dividing_owner && waiting.number == dividing_number));
      assert (!\u_hit_select.valid_tree || (chosen.owner == \u_hit_select.tag_tree && steps_left >= lod_pkg::HIT_DIVIDE_LATENCY - 1));
      assert (!\u_hit_select.valid_id || (chosen.owner == \u_hit_select.tag_id && steps_left >= lod_pkg::HIT_DIVIDE_LATENCY - 2));
      assert (!select_valid || (chosen.owner == select_owner && steps_left >= lod_pkg::HIT_DIVIDE_LATENCY - 3));
      // Ticks go on: at most as many cycles without one as the limit says.
      assert (since_q == ticks_q && (tick || since_q < scene_i.answer_limit));
    end
    cover (live[0] && 32'(\u_queue.len_q ) == 3 && queued[1] == 8'd2);
    cover (live[0] && select_valid && 32'(select_owner) == 1);
  end
