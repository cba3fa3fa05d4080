  // Inside memory_1w1r: its words, for a property of what is around it.
  logic [WORDS-1:0][WORD_W-1:0] words;
  for (genvar k = 0; k < WORDS; k++) begin : g_words
    if (DISTRIBUTED) begin : g_of_distributed
      assign words[k] = g_distributed.words_q[k];
    end else begin : g_of_any
      assign words[k] = g_any.words_q[k];
    end
  end
