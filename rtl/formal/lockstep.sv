`default_nettype none

/// Registers side by side.

/// Two elastic registers of one kind with the same offers and the same receiver keep the same valid and ready: one may speak for the other. So do
/// two pipelines of the same registers at the same stages, from the first stage on and from the last one back.
module lockstep (
  input logic       clk_i,
  input logic       rst_ni,
  input logic [1:0] valid_i,
  input logic [1:0] ready_i,
  input logic [3:0] data_i,
  input logic [8:0] wide_i
);

  logic [1:0]  valid, other_valid, ready, other_ready;
  logic [7:0]  unused_data;
  logic [17:0] unused_wide;
  pipe_stage #(.W(4)) u_stage (
    .clk_i, .rst_ni, .valid_i(valid_i[0]), .ready_o(ready[0]), .data_i, .valid_o(valid[0]), .ready_i(ready_i[0]), .data_o(unused_data[3:0])
  );
  pipe_stage #(.W(9)) u_other_stage (
    .clk_i, .rst_ni, .valid_i(valid_i[0]), .ready_o(other_ready[0]), .data_i(wide_i), .valid_o(other_valid[0]), .ready_i(ready_i[0]),
    .data_o(unused_wide[8:0])
  );
  pipe_skid #(.W(4)) u_skid (
    .clk_i, .rst_ni, .valid_i(valid_i[1]), .ready_o(ready[1]), .data_i, .valid_o(valid[1]), .ready_i(ready_i[1]), .data_o(unused_data[7:4])
  );
  pipe_skid #(.W(9)) u_other_skid (
    .clk_i, .rst_ni, .valid_i(valid_i[1]), .ready_o(other_ready[1]), .data_i(wide_i), .valid_o(other_valid[1]), .ready_i(ready_i[1]),
    .data_o(unused_wide[17:9])
  );

  logic live_q;  // reset has been
  initial live_q = 1'b0;
  always_ff @(posedge clk_i) if (!rst_ni) live_q <= 1'b1;

  always_comb begin
    if (live_q) assert (valid == other_valid && ready == other_ready);
    cover (live_q && valid == '1 && ready == '0);
  end

endmodule

`default_nettype wire
