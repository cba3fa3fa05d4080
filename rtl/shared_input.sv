`default_nettype none

/// The way of `N` requesters into one block: a round-robin arbiter and the winner's operands.
///
/// `valid_o` and `data_o` go to the block, all zero if nobody requests (the operands are gated, not only chosen); `grant_o` tells the winner that the
/// block takes it in this cycle. Combinational but for the arbiter's memory.
/// With `LINK_REGISTERS`, and the block's `INTERVAL`, a `link_register` stands between.
module shared_input #(
  parameter int unsigned N = lod_pkg::CONTEXTS,
  parameter int unsigned W = 1,
  parameter int unsigned INTERVAL = 0
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

  localparam bit REGISTERED = lod_pkg::LINK_REGISTERS != 0 && INTERVAL != 0;

  logic                          take, valid;
  logic [N-1:0]                  winner;
  logic [W-1:0]                  data;
  logic [lod_pkg::CONTEXT_W-1:0] index;

  arbiter #(.N(N)) u_arbiter (
    .clk_i, .rst_ni, .request_i, .take_i(take), .grant_o(winner), .index_o(index)
  );

  assign valid   = request_i != '0;
  assign grant_o = take ? winner : '0;

  always_comb begin
    data = '0;
    for (int unsigned k = 0; k < N; k++) begin
      data = data | (data_i[k] & {W{winner[k]}});
    end
  end

  if (REGISTERED) begin : g_register
    link_register #(.W(W + lod_pkg::CONTEXT_W), .INTERVAL(INTERVAL)) u_register (
      .clk_i, .rst_ni, .valid_i(valid), .ready_o(take), .data_i({data, index}), .valid_o, .ready_i, .data_o({data_o, index_o})
    );
  end else begin : g_wires
    assign take    = ready_i;
    assign valid_o = valid;
    assign data_o  = data;
    assign index_o = index;
  end

endmodule

`default_nettype wire
