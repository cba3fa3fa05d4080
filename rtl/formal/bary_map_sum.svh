  // Inside bary_map: what is in a stage adds up to 1, from the input to the output.
  logic live_q;  // reset has been
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) if (!rst_ni) live_q <= 1'b1;

  function automatic logic whole(input logic [3*B_W-1:0] w);
    whole = {2'b0, w[0 +: B_W]} + {2'b0, w[B_W +: B_W]} + {2'b0, w[2*B_W +: B_W]} == {3'd1, {(B_W-1){1'b0}}};
  endfunction

  always_comb begin
    assume (whole(state[0][TAG_W +: 3*B_W]) || !valid_i);
    for (int unsigned k = 1; k <= LEVELS; k++) assert (!live_q || !valid[k] || whole(state[k][TAG_W +: 3*B_W]));
    cover (live_q && valid_o && !valid[LEVELS-1] && node == 20'd9);
    cover (live_q && valid[1] && valid[2] && !ready[2] && !ready_o);
  end

