  // Inside ray_context, besides ray_context.svh: every step brings the ray nearer to its hit. What is left of a ray is, in this order: its stage; the entries that it may still visit; the
  // steps until it visits the next. Cycles without a step wait for one thing, which is named; a wait for memory ends with two ticks, whatever memory does.
  localparam int unsigned STACK_LEN_W = $clog2(lod_pkg::STACK_ENTRIES + 1);
  localparam int unsigned STEPS_W = 9;
  (* hierconn *) logic [STACK_LEN_W-1:0] \u_stack.len_q ;

  // Of lines wanted and waited for: each is granted and comes, or the first tick passes, and the second is an error.
  logic [STEPS_W-1:0] lines_left, entries_left;
  assign lines_left   = record_there ? '0 : STEPS_W'(2 * (32'(want_q[0]) + 32'(want_q[1])) + 32'(waiting_q[0]) + 32'(waiting_q[1])) * 2 + STEPS_W'(!stale_q);
  assign entries_left = STEPS_W'(\u_stack.len_q );

  // Steps to the next visit at most, or to the end.
  logic [STEPS_W-1:0] steps;
  logic [2:0]         stage;
  logic               waits;
  always_comb begin
    steps = '0;
    waits = 1'b0;
    stage = 3'd2;
    case (state_q)
      lod_pkg::SETUP:       begin stage = 3'd4; waits = !setup_grant_i; end
      lod_pkg::SETUP_WAIT:  begin stage = 3'd3; waits = !setup_valid_i; end
      lod_pkg::VISIT:       steps = '0;
      lod_pkg::POP:         steps = STEPS_W'(1) + entries_left;
      lod_pkg::TRI:         begin
        steps = STEPS_W'(2) + STEPS_W'(left_q) + STEPS_W'(left_q) + STEPS_W'(pending_q) + entries_left;
        waits = !tri_grant_i && !tri_miss_i && !select_valid_i && (left_q != '0 || pending_q != '0);
      end
      lod_pkg::PUSH:        steps = STEPS_W'(2) + STEPS_W'(count_q) + STEPS_W'(count_q) + entries_left;
      lod_pkg::CHILD_WAIT:  begin steps = STEPS_W'(17) + entries_left; waits = !child_valid_i; end
      lod_pkg::CHILD:       begin steps = STEPS_W'(18) + entries_left + lines_left; waits = waiting_q[0] ? !line_moves : !child_grant_i && error_q == lod_pkg::ERROR_NONE; end
      lod_pkg::MORPH_WAIT:  begin steps = STEPS_W'(25) + entries_left + lines_left; waits = !morph_valid_i; end
      lod_pkg::MORPH:       begin steps = STEPS_W'(26) + entries_left + lines_left; waits = !morph_grant_i; end
      lod_pkg::LOD_WAIT:    begin steps = STEPS_W'(47) + entries_left; waits = !lod_valid_i; end
      lod_pkg::LOD:         begin steps = STEPS_W'(48) + entries_left; waits = !lod_grant_i && !decided; end
      lod_pkg::DECIDE_WAIT: begin steps = STEPS_W'(49) + entries_left; waits = !decide_valid_i; end
      lod_pkg::DECIDE:      begin steps = STEPS_W'(50) + entries_left; waits = !decide_grant_i; end
      lod_pkg::FETCH:       begin
        steps = (of_split ? STEPS_W'(27) : fetch_q == lod_pkg::RECORD ? STEPS_W'(51) : STEPS_W'(19)) + entries_left + lines_left;
        waits = !fetched && !line_moves;
      end
      lod_pkg::DIVIDE_V:    begin stage = 3'd1; steps = STEPS_W'(7); waits = !divide_grant_i; end
      lod_pkg::DIVIDE_W:    begin stage = 3'd1; steps = STEPS_W'(6); waits = !divide_grant_i; end
      lod_pkg::DIVIDE_WAIT: begin stage = 3'd1; steps = STEPS_W'(5); waits = !(divide_valid_i && divide_what_i == lod_pkg::DIVIDE_FOR_W); end
      lod_pkg::SUM:         begin stage = 3'd1; steps = STEPS_W'(4); end
      lod_pkg::MAP:         begin stage = 3'd1; steps = STEPS_W'(3); waits = !map_grant_i; end
      lod_pkg::MAP_WAIT:    begin stage = 3'd1; steps = STEPS_W'(2); waits = !map_valid_i; end
      lod_pkg::DONE:        begin stage = 3'd1; steps = STEPS_W'(1); waits = !hit_grant_i; end
      default:              stage = 3'd0;
    endcase
    // An error is one step more, and kept: it comes once.
    if (stage == 3'd2 && error_q == lod_pkg::ERROR_NONE) steps = steps + STEPS_W'(1);
  end
  // A line is granted, comes or is late: an error is kept, or ends the ray now.
  logic line_moves, fetched;
  assign line_moves = granted != '0 || arrived != '0 || tick_i || error_q != lod_pkg::ERROR_NONE;
  assign fetched    = of_split ? want_q == '0 && !waiting_q[1] && !(compact && waiting_q[0]) : record_there;

  logic [3+32+STEPS_W-1:0] left, left_before_q;
  logic                    steps_q, waits_q, visits_now_q;
  logic [31:0]             visits_before_q;
  assign left = {stage, stage == 3'd2 ? visits_q : 32'd0, steps};
  always_ff @(posedge clk_i) begin
    {steps_q, waits_q} <= rst_ni && !idle_o ? {!waits, waits} : 2'b00;
    left_before_q      <= left;
    visits_now_q       <= rst_ni && state_q == lod_pkg::VISIT;
    visits_before_q    <= visits_q;
  end

  always_comb begin
    if (live) begin
      assert (!steps_q || left < left_before_q);
      assert (!waits_q || left <= left_before_q);
      // A bound: the stack and what is left of one visit.
      assert (32'(steps) <= lod_pkg::STACK_ENTRIES + 61 && 32'(entries_left) <= lod_pkg::STACK_ENTRIES);
      // Who waits asks for something now, or has asked for it and not got it.
      assert (!waits || decide_request_o || setup_request_o || fetch_request_o || child_request_o || lod_request_o || morph_request_o || tri_request_o || divide_request_o || map_request_o || hit_request_o
              || inside != '0 || asked != '0 || tested != '0 || w_inside);
      // Each visit counts, and there is none after the last.
      assert (!visits_now_q || (visits_before_q == '0 ? state_q == lod_pkg::DONE && error_q != lod_pkg::ERROR_NONE : visits_q == visits_before_q - 32'd1));
    end
    cover (live && visits_now_q && visits_before_q == 32'd1);
    cover (live && waits_q && state_q == lod_pkg::FETCH && stale_q);
    cover (live && steps_q && state_q == lod_pkg::CHILD);
  end
