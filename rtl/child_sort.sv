`default_nettype none

/// Order of four children by entry distance. Twin of src/block/child_sort.rs (paper figure 9, "sort child nodes").
///
/// Hit children first, nearer before farther, equal distances by child number; missed ones follow by number. A network of five comparators on the keys
/// {missed, t_near, number}, all different; a missed child's distance counts as 0. Legal: anything. Latency CHILD_SORT_LATENCY = 3, interval 1.
module child_sort #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic                     valid_i,
  output logic                     ready_o,
  input  lod_pkg::child_sort_in_t  in_i,
  input  logic [TAG_W-1:0]         tag_i,
  output logic                     valid_o,
  input  logic                     ready_i,
  output lod_pkg::child_sort_out_t out_o,
  output logic [TAG_W-1:0]         tag_o
);

  // {missed, t_near, number}.
  localparam int unsigned KEY_W = 1 + lod_pkg::T_NEAR_W + 2;
  localparam int unsigned STAGE_W = 3 + 4 * KEY_W + TAG_W;
  if (lod_pkg::CHILD_SORT_LATENCY != 3) begin : g_illegal_latency
    $error("child_sort: lod_pkg::CHILD_SORT_LATENCY must be 3");
  end

  logic [3:0][KEY_W-1:0] key, first, first_q, second, second_q, third, third_q;
  logic [2:0]            count, count_first, count_second, count_third;
  logic                  valid_first, ready_first, valid_second, ready_second;
  logic [TAG_W-1:0]      tag_first, tag_second;

  always_comb begin
    count = '0;
    for (int unsigned k = 0; k < 4; k++) begin
      key[k] = {!in_i.hit[k], in_i.t_near[k] & {lod_pkg::T_NEAR_W{in_i.hit[k]}}, 2'(k)};
      count  = count + 3'(in_i.hit[k]);
    end
  end

  // (0, 1) and (2, 3); then (0, 2) and (1, 3); then (1, 2).
  assign first  = {key[2] < key[3] ? {key[3], key[2]} : {key[2], key[3]}, key[0] < key[1] ? {key[1], key[0]} : {key[0], key[1]}};
  pipe_stage #(.W(STAGE_W)) u_first (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({count, first, tag_i}),
    .valid_o(valid_first), .ready_i(ready_first), .data_o({count_first, first_q, tag_first})
  );

  always_comb begin
    {second[2], second[0]} = first_q[0] < first_q[2] ? {first_q[2], first_q[0]} : {first_q[0], first_q[2]};
    {second[3], second[1]} = first_q[1] < first_q[3] ? {first_q[3], first_q[1]} : {first_q[1], first_q[3]};
  end
  pipe_stage #(.W(STAGE_W)) u_second (
    .clk_i, .rst_ni, .valid_i(valid_first), .ready_o(ready_first), .data_i({count_first, second, tag_first}),
    .valid_o(valid_second), .ready_i(ready_second), .data_o({count_second, second_q, tag_second})
  );

  assign third = {second_q[3], second_q[1] < second_q[2] ? {second_q[2], second_q[1]} : {second_q[1], second_q[2]}, second_q[0]};
  pipe_stage #(.W(STAGE_W)) u_third (
    .clk_i, .rst_ni, .valid_i(valid_second), .ready_o(ready_second), .data_i({count_second, third, tag_second}),
    .valid_o, .ready_i, .data_o({count_third, third_q, tag_o})
  );

  assign out_o = {count_third, third_q[3][1:0], third_q[2][1:0], third_q[1][1:0], third_q[0][1:0]};

  // The last stage keeps whole keys; only the numbers leave.
  logic unused_keys;
  assign unused_keys = ^{third_q[3][KEY_W-1:2], third_q[2][KEY_W-1:2], third_q[1][KEY_W-1:2], third_q[0][KEY_W-1:2]};

endmodule

`default_nettype wire
