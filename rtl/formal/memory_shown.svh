  // Inside memory_1w1r: two of its words, at places that the property around it names.
  logic [$clog2(WORDS)-1:0] shown_place, other_place;
  logic [WORD_W-1:0]        shown, other;
  if (DISTRIBUTED) begin : g_shown
    assign {shown, other} = {g_distributed.words_q[shown_place], g_distributed.words_q[other_place]};
  end else begin : g_shown_of_any
    assign {shown, other} = {g_any.words_q[shown_place], g_any.words_q[other_place]};
  end
