  // Inside edge_opening: the first stage, also against any other edge, and the last one. The division lies between them.
  (* anyseq *) logic [lod_pkg::BOUND_W-1:0] other_h;
  (* anyseq *) logic [D_W-1:0] other_d;
  (* anyseq *) logic [BITS-1:0] other_quotient;
  localparam int unsigned WIDE = D_W + 2;
  logic [WIDE-1:0] wide_h, wide_d, wide_other_h, wide_other_d;
  assign {wide_h, wide_d}             = {WIDE'(h_i), WIDE'(d_i)};
  assign {wide_other_h, wide_other_d} = {WIDE'(other_h), WIDE'(other_d)};

  // Between closed and open the division starts from h - D over D.
  logic between, other_between, open_first, full_first;
  logic [D_W-1:0]  divisor_first, remainder_first;
  logic [BITS-1:0] quotient_first;
  assign {open_first, full_first, divisor_first, remainder_first, quotient_first} = state[0];
  assign between       = wide_h > wide_d && wide_h < 2 * wide_d;
  assign other_between = wide_other_h > wide_other_d && wide_other_h < 2 * wide_other_d;

  always_comb begin
    assert (open_first == (wide_h > wide_d) && full_first == (wide_h >= 2 * wide_d) && quotient_first == '0);
    assert (!between || (divisor_first == d_i && WIDE'(remainder_first) == wide_h - wide_d && remainder_first < divisor_first));
    // Against an edge with no larger bound of which no less is tolerated.
    if (other_h <= h_i && other_d >= d_i) begin
      assert (!between || !other_between || (WIDE'(remainder_first) >= wide_other_h - wide_other_d && divisor_first <= other_d));
      assert (!(wide_other_h > wide_other_d) || open_first);
      assert (!(wide_other_h > wide_other_d && wide_other_h >= 2 * wide_other_d) || (open_first && full_first));
    end
    // The last stage: the state between 1 and 255 grows with the quotient.
    assert (!open || full || (s_o == S_W'(quotient == '0 ? BITS'(1) : quotient) && s_o >= 1 && s_o <= 255));
    assert (open || s_o == '0);
    assert (!(open && full) || s_o == S_W'(lod_pkg::S_ONE));
    assert (!open || full || other_quotient > quotient || s_o >= S_W'(other_quotient == '0 ? BITS'(1) : other_quotient));
    cover (between && other_between && other_h < h_i && other_d > d_i);
    cover (open && !full && quotient == '0);
  end

