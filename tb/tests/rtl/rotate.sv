`default_nettype none

/// A block for the testbench's own tests: {x, y, z} becomes {y, z, ~x}, three cycles later. FAULT breaks one rule each, so that the tests can
/// show that it is noticed; 0 breaks none.
module rotate #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned FAULT = 0
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [95:0]      in_i,
  input  logic [TAG_W-1:0] tag_i,
  output logic             valid_o,
  input  logic             ready_i,
  output logic [95:0]      out_o,
  output logic [TAG_W-1:0] tag_o
);

  localparam int unsigned STAGES = (FAULT == 4) ? 4 : 3;

  logic             valid;
  logic             ready;
  logic [95:0]      rotated;
  logic [95:0]      data;
  logic [TAG_W-1:0] tag;
  logic [9:0]       count_q;
  logic             pause_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) count_q <= '0;
    else if (valid_i && ready_o) count_q <= count_q + 1'b1;
  end

  // 1: one bit of one output in 1024 is wrong.
  assign rotated = {in_i[63:0], ~in_i[95:64]} ^ 96'((FAULT == 1 && count_q == 10'd700) ? 1 : 0);

  // 2: one input in 1024 is lost. 7: every other cycle takes nothing. 11: nothing is taken while an output waits.
  logic take, refuse;
  logic hold_q;
  logic [3:0] wait_q;
  assign refuse  = (FAULT == 7 && hold_q) || (FAULT == 11 && wait_q != '0);
  assign take    = valid_i && !(FAULT == 2 && count_q == 10'd700) && !refuse;
  assign ready_o = ready && !refuse;
  always_ff @(posedge clk_i) hold_q <= rst_ni && valid_i && ready_o;

  pipe_delay #(.W(96 + TAG_W), .STAGES(STAGES)) u_delay (
    .clk_i, .rst_ni,
    .valid_i(take), .ready_o(ready), .data_i({rotated, tag_i}),
    .valid_o(valid), .ready_i(ready_i && !pause_q), .data_o({data, tag})
  );

  // 10: behind an output that has waited the next one comes a cycle late.
  always_ff @(posedge clk_i) pause_q <= FAULT == 10 && rst_ni && valid && ready_i && wait_q != '0;

  // 3: the output does not hold still while it waits.
  always_ff @(posedge clk_i) wait_q <= (valid && !ready_i) ? wait_q + 1'b1 : '0;
  assign out_o = data ^ 96'((FAULT == 3 && wait_q == 4'd15) ? 1 : 0);

  // 5: the output is withdrawn while it waits. 6: it depends on an input.
  assign valid_o = valid && !pause_q && !(FAULT == 5 && wait_q == 4'd9) && !(FAULT == 6 && tag_i == '0);

  // 8: the tag is another one's.
  assign tag_o = (FAULT == 8) ? ~tag : tag;

  // 9: an assertion fails.
  always_ff @(posedge clk_i) assert (!rst_ni || FAULT != 9 || count_q != 10'd700);

endmodule

`default_nettype wire
