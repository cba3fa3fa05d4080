`default_nettype none

/// One block's place among `N` contexts: their way into it (`shared_input`), its clock, and the way of its results back (`shared_output`), who always have a place.
///
/// Towards the contexts: requests with operands, a grant, and `for_o`, one-hot: whom the result of this cycle is for. Towards the block: its valid, ready, operands and tag, and its results.
/// The context's number is what `for_o` finds in the upper bits of the result's tag.
module station #(
  parameter int unsigned N = lod_pkg::CONTEXTS,
  parameter int unsigned IN_W = 1,
  parameter int unsigned OUT_W = 1,
  parameter int unsigned TAG_W = lod_pkg::CONTEXT_W,
  parameter int unsigned INTERVAL = 0,
  // Items of a context that the block may have at once.
  parameter int unsigned EACH = 1,
  parameter bit CLOCK_GATES = 1'b0
) (
  input  logic                          clk_i,
  input  logic                          rst_ni,
  // The contexts' side.
  input  logic [N-1:0]                  request_i,
  input  logic [N-1:0][IN_W-1:0]        data_i,
  output logic [N-1:0]                  grant_o,
  output logic                          valid_o,
  output logic [N-1:0]                  for_o,
  output logic [OUT_W-1:0]              out_o,
  output logic [TAG_W-1:0]              tag_o,
  // The block's side.
  output logic                          block_clk_o,
  output logic                          block_valid_o,
  input  logic                          block_ready_i,
  output logic [IN_W-1:0]               block_data_o,
  output logic [lod_pkg::CONTEXT_W-1:0] block_index_o,
  input  logic                          made_valid_i,
  input  logic [OUT_W-1:0]              made_i,
  input  logic [TAG_W-1:0]              made_tag_i
);

  shared_input #(.N(N), .W(IN_W), .INTERVAL(INTERVAL)) u_input (
    .clk_i, .rst_ni, .request_i, .data_i, .grant_o,
    .valid_o(block_valid_o), .ready_i(block_ready_i), .data_o(block_data_o), .index_o(block_index_o)
  );

  block_clock #(.MOST(EACH * N), .GATED(CLOCK_GATES)) u_clock (
    .clk_i, .rst_ni, .valid_i(block_valid_o), .ready_i(block_ready_i), .made_i(made_valid_i), .clk_o(block_clk_o)
  );

  shared_output #(.W(OUT_W), .TAG_W(TAG_W)) u_output (
    .clk_i, .rst_ni, .valid_i(made_valid_i), .out_i(made_i), .tag_i(made_tag_i), .valid_o, .out_o, .tag_o
  );

  for (genvar k = 0; k < N; k++) begin : g_for
    assign for_o[k] = valid_o && tag_o[TAG_W-1 -: lod_pkg::CONTEXT_W] == lod_pkg::CONTEXT_W'(k);
  end

endmodule

`default_nettype wire
