`default_nettype none

/// The end of the triangle test: from u, v, w with their tie signs and t_num to hit, face and positive numbers.
///
/// An edge function counts as positive if it is above 0, or if it is 0 and its tie sign says so. Hit iff all three agree, det = u + v + w != 0 and
/// t_num / det > 0. Where the signs agree no two of u, v, w have opposite signs, so det = 0 iff all three are 0, and all sums stay below 2^96;
/// where they do not, sums may wrap: it is a miss. out_o is {hit, front, v, w, det, t_num}, magnitudes of one bit less than what came in. Its second register is a `pipe_skid`. Latency: lod_pkg::TRI_DECIDE_LATENCY = 3; interval 1.
module tri_decide #(
  parameter int unsigned TAG_W = 8,
  parameter int unsigned EDGE_W = lod_pkg::SIGNED_EDGE_W,
  parameter int unsigned T_W = lod_pkg::SIGNED_T_NUMERATOR_W
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  logic [EDGE_W-1:0]       u_i,
  input  logic [EDGE_W-1:0]       v_i,
  input  logic [EDGE_W-1:0]       w_i,
  input  logic                    tie_u_i,
  input  logic                    tie_v_i,
  input  logic                    tie_w_i,
  input  logic [T_W-1:0]          t_num_i,
  input  logic [TAG_W-1:0]        tag_i,
  output logic                    valid_o,
  input  logic                    ready_i,
  output logic [3*EDGE_W+T_W-3:0] out_o,
  output logic [TAG_W-1:0]        tag_o
);

  // Stage 1: signs, and the first sum of det.
  logic              some_u, some_v, some_w, some_t;
  logic              positive_u, positive_v, positive_w;
  logic [EDGE_W-1:0] uv;
  assign some_u     = u_i != 0;
  assign some_v     = v_i != 0;
  assign some_w     = w_i != 0;
  assign some_t     = t_num_i != 0;
  assign positive_u = some_u ? !u_i[EDGE_W-1] : tie_u_i;
  assign positive_v = some_v ? !v_i[EDGE_W-1] : tie_v_i;
  assign positive_w = some_w ? !w_i[EDGE_W-1] : tie_w_i;
  assign uv         = u_i + v_i;

  logic              valid_signs, ready_signs;
  logic              some_u_q, some_v_q, some_w_q, some_t_q;
  logic              positive_u_q, positive_v_q, positive_w_q;
  logic [EDGE_W-1:0] uv_q, v_q, w_q;
  logic [T_W-1:0]    t_num_q;
  logic [TAG_W-1:0]  tag_q;
  pipe_stage #(.W(7 + 3 * EDGE_W + T_W + TAG_W)) u_signs (
    .clk_i, .rst_ni, .valid_i, .ready_o,
    .data_i({some_u, some_v, some_w, some_t, positive_u, positive_v, positive_w, uv, v_i, w_i, t_num_i, tag_i}),
    .valid_o(valid_signs), .ready_i(ready_signs),
    .data_o({some_u_q, some_v_q, some_w_q, some_t_q, positive_u_q, positive_v_q, positive_w_q, uv_q, v_q, w_q, t_num_q, tag_q})
  );

  // Stage 2: the decision, and det.
  logic              agree, ahead, hit;
  logic [EDGE_W-1:0] det;
  assign agree = positive_u_q == positive_v_q && positive_u_q == positive_w_q;
  assign ahead = some_t_q && t_num_q[T_W-1] != positive_u_q;
  assign hit   = agree && ahead && (some_u_q || some_v_q || some_w_q);
  assign det   = uv_q + w_q;

  logic              valid_det, ready_det;
  logic              hit_q, front_q;
  logic [EDGE_W-1:0] det_q, v_det_q, w_det_q;
  logic [T_W-1:0]    t_num_det_q;
  logic [TAG_W-1:0]  tag_det_q;
  pipe_skid #(.W(2 + 3 * EDGE_W + T_W + TAG_W)) u_det (
    .clk_i, .rst_ni, .valid_i(valid_signs), .ready_o(ready_signs),
    .data_i({hit, hit && !positive_u_q, det, v_q, w_q, t_num_q, tag_q}),
    .valid_o(valid_det), .ready_i(ready_det), .data_o({hit_q, front_q, det_q, v_det_q, w_det_q, t_num_det_q, tag_det_q})
  );

  // Stage 3: the numbers with det > 0, or all zero on a miss. They are magnitudes: their sign bits end up 0.
  logic [EDGE_W-1:0]      v, w, det_positive;
  logic [T_W-1:0]         t_num;
  assign v            = ((v_det_q ^ {EDGE_W{front_q}}) & {EDGE_W{hit_q}}) + EDGE_W'(front_q);
  assign w            = ((w_det_q ^ {EDGE_W{front_q}}) & {EDGE_W{hit_q}}) + EDGE_W'(front_q);
  assign det_positive = ((det_q ^ {EDGE_W{front_q}}) & {EDGE_W{hit_q}}) + EDGE_W'(front_q);
  assign t_num        = ((t_num_det_q ^ {T_W{front_q}}) & {T_W{hit_q}}) + T_W'(front_q);

  logic unused_signs;
  assign unused_signs = ^{v[EDGE_W-1], w[EDGE_W-1], det_positive[EDGE_W-1], t_num[T_W-1]};

  pipe_stage #(.W(2 + 3 * (EDGE_W - 1) + T_W - 1 + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_det), .ready_o(ready_det),
    .data_i({hit_q, front_q, v[EDGE_W-2:0], w[EDGE_W-2:0], det_positive[EDGE_W-2:0], t_num[T_W-2:0], tag_det_q}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
