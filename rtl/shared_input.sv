`default_nettype none

/// The way of `N` requesters into one block: a round-robin arbiter and the winner's operands.
///
/// `valid_o` and `data_o` go to the block, all zero if nobody requests (the operands are gated, not only chosen); `grant_o` tells the winner that the
/// block takes it in this cycle. Combinational but for the arbiter's memory.
module shared_input #(
  parameter int unsigned N = lod_pkg::CONTEXTS,
  parameter int unsigned W = 1
) (
  input  logic                          clk_i,
  input  logic                          rst_ni,
  input  logic [N-1:0]                  request_i,
  input  logic [N-1:0][W-1:0]           data_i,
  output logic [N-1:0]                  grant_o,
  output logic                          valid_o,
  input  logic                          ready_i,
  output logic [W-1:0]                  data_o,
  output logic [lod_pkg::CONTEXT_W-1:0] index_o
);

  logic [N-1:0] winner;

  arbiter #(.N(N)) u_arbiter (
    .clk_i, .rst_ni, .request_i, .take_i(ready_i), .grant_o(winner), .index_o
  );

  assign valid_o = request_i != '0;
  assign grant_o = ready_i ? winner : '0;

  always_comb begin
    data_o = '0;
    for (int unsigned k = 0; k < N; k++) begin
      data_o = data_o | (data_i[k] & {W{winner[k]}});
    end
  end

endmodule

`default_nettype wire
