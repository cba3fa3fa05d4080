`default_nettype none

/// Round-robin choice among `N` requests.
///
/// The winner is the first request at or after the place behind the last one taken, cyclically; place 0 after reset. `take_i` says that the resource takes
/// the winner in this cycle; without it the choice is made anew in the next. `grant_o` is one-hot, or zero if nobody requests. Combinational.
module arbiter #(
  parameter int unsigned N = lod_pkg::CONTEXTS
) (
  input  logic                          clk_i,
  input  logic                          rst_ni,
  input  logic [N-1:0]                  request_i,
  input  logic                          take_i,
  output logic [N-1:0]                  grant_o,
  output logic [lod_pkg::CONTEXT_W-1:0] index_o
);

  if (N < 1 || N > lod_pkg::MAX_CONTEXTS) begin : g_illegal
    $error("arbiter: N = %0d, must be 1 to %0d", N, lod_pkg::MAX_CONTEXTS);
  end

  // The places behind the last winner, up to the top. None of them stands for all of them.
  logic [N-1:0] behind_q;
  logic [N-1:0] upper;
  logic [N-1:0] candidates;

  assign upper      = request_i & behind_q;
  assign candidates = (upper != '0) ? upper : request_i;
  assign grant_o    = candidates & (~candidates + N'(1));

  always_comb begin
    index_o = '0;
    for (int unsigned k = 0; k < N; k++) begin
      if (grant_o[k]) index_o = index_o | lod_pkg::CONTEXT_W'(k);
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) behind_q <= '0;
    // Twice the winner's bit minus one covers the winner and all below.
    else if (take_i && request_i != '0) behind_q <= ~((grant_o << 1) - N'(1));
  end

endmodule

`default_nettype wire
