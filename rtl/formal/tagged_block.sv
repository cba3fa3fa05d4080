`default_nettype none

/// What is inside a block whose outputs are free: it takes inputs when it likes and gives for each one result, with its tag, in any order and any time later. That is assumed of the
/// block; asserted is that no tag goes into it twice.
module tagged_block #(
  parameter int unsigned TAGS = 4,
  parameter int unsigned TAG_W = 6
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             live_i,
  input  logic             take_i,
  input  logic [TAG_W-1:0] take_tag_i,
  input  logic             give_i,
  input  logic [TAG_W-1:0] give_tag_i,
  output logic [TAGS-1:0]  inside_o
);

  logic [TAGS-1:0] inside_q, takes, gives;
  assign inside_o = inside_q;
  assign takes    = take_i ? TAGS'(1) << take_tag_i : '0;
  assign gives    = give_i ? TAGS'(1) << give_tag_i : '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) inside_q <= '0;
    else inside_q <= (inside_q | takes) & ~gives;
  end

  always_comb begin
    assume (!give_i || (gives & inside_q) != '0);
    if (live_i) assert (!take_i || (takes != '0 && (takes & inside_q) == '0));
  end

endmodule

`default_nettype wire
