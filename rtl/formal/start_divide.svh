  // Inside start_divide: what it holds, from the input taken to the result given. Where the numbers are narrow, the division's invariant as a product too.
  localparam bit NARROW = QUOTIENT_W <= 8;
  localparam int unsigned WIDE = NARROW ? QUOTIENT_W + DIVISOR_W + 3 : 1;
  logic                     live_q;  // reset has been
  logic                     held_q;  // an input was taken and its result not given
  lod_pkg::start_divide_in_t  taken_q;
  logic [TAG_W-1:0]         taken_tag_q;
  logic [STEP_W-1:0]        age_q;  // cycles since, less one
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) {live_q, held_q} <= 2'b10;
    else if (valid_i && ready_o) {held_q, taken_q, taken_tag_q, age_q} <= {1'b1, in_i, tag_i, STEP_W'(0)};
    else if (valid_o && ready_i) held_q <= 1'b0;
    else if (age_q != STEP_W'(STEPS)) age_q <= age_q + STEP_W'(1);
  end

  // The quotient's bits so far; older ones are of another division.
  localparam int unsigned AGE_BITS_W = STEP_W + 2;
  logic [AGE_BITS_W-1:0] age_bits;
  logic [QUOTIENT_W-1:0] known, quotient;
  assign age_bits = AGE_BITS_W'(age_q) * AGE_BITS_W'(DIVIDE_BITS);
  assign known    = age_q == STEP_W'(STEPS) ? '1 : (QUOTIENT_W'(1) << age_bits) - QUOTIENT_W'(1);
  assign quotient = quotient_q & known;

  // The divisor: 8 denominator or 16, as the steps give no more bits than the quotient has or one more, which is 0.
  logic [DIVISOR_W-1:0] divisor;
  assign divisor = {taken_q.denominator, {ZEROS{1'b0}}};

  always_comb begin
    assume (!valid_i || in_i.denominator != '0);
    if (live_q) begin
      assert (busy_q == held_q);
      assert (ready_o == (!held_q || (valid_o && ready_i)));
      if (held_q) begin
        assert (age_q <= STEP_W'(STEPS) && steps_left_q == STEP_W'(STEPS) - age_q);
        // The result is there after the steps for all its bits, with its own tag, and stays.
        assert (valid_o == (age_q == STEP_W'(STEPS)));
        assert (tag_o == taken_tag_q);
        assert (taken_q.denominator != '0);
        // It saturates iff it must, and then every bit is set.
        assert (saturated_q == (DIVISOR_W'(taken_q.numerator) >= {taken_q.denominator, {WHOLE_W{1'b0}}}));
        assert (!saturated_q || quotient == known);
        assert (age_q != '0 || remainder_q == DIVISOR_W'(taken_q.numerator));
        // The bits of low that are still to be brought down.
        assert (low_q == taken_q.low << age_bits);
      end
    end
    cover (live_q && valid_o && ready_i && valid_i && saturated_q);
    cover (live_q && valid_o && !saturated_q && out_o[QUOTIENT_W-1:QUOTIENT_W-2] == 2'd1 && divisor[DIVISOR_W-1]);
  end

  // The multiples are those of its own denominator (`divide_multiples_exact`).
  logic [ODDS-1:0][MULTIPLE_W-1:0] own_odd;
  divide_multiples #(.W(lod_pkg::EDGE_FUNCTION_W), .BITS(DIVIDE_BITS)) u_own (.divisor_i(taken_q.denominator), .odd_o(own_odd));
  always_comb assert (!live_q || !held_q || odd_q == own_odd);

  // Low's bits so far, and zeros where steps go beyond them.
  if (NARROW) begin : g_narrow
    logic [WIDE-1:0] whole, low, parts;
    assign low   = WIDE'(({{QUOTIENT_W+2{1'b0}}, taken_q.low} << age_bits) >> LOW_W);
    assign whole = (WIDE'(taken_q.numerator) << age_bits) + low;
    assign parts = WIDE'(quotient) * WIDE'(divisor) + WIDE'(remainder_q);
    always_comb begin
      if (live_q && held_q && !saturated_q) begin
        assert (remainder_q < divisor);
        assert (whole == parts);
      end
    end
  end
