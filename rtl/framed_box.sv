`default_nettype none

/// A box in the frame of a node as one of 16-bit codes: what `box_decode` and `box_decode8` are, for planes of 5 and of 8 bits.
///
/// Each plane is min(32767, origin + steps), steps = floor(v (2 + half) 2^exponent / 2). Legal: origin >= -32767. Latency 2, interval 1.
module framed_box #(
  parameter int unsigned PLANE_W = 5,
  parameter int unsigned TAG_W = 8
) (
  input  logic             clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  lod_pkg::code3_t         origin_i,
  input  logic [2:0]              halves_i,
  input  logic [2:0][3:0]         exponents_i,
  // Of both corners as structs lie: z of the upper one first, x of the lower one last.
  input  logic [5:0][PLANE_W-1:0] planes_i,
  input  logic [TAG_W-1:0]        tag_i,
  output logic                    valid_o,
  input  logic                    ready_i,
  output lod_pkg::box16_t         bounds_o,
  output logic [TAG_W-1:0]        tag_o
);

  localparam int unsigned CODE_W = lod_pkg::CODE3_W / 3;
  // Times 2 or 3.
  localparam int unsigned PRODUCT_W = PLANE_W + 2;
  // A code and 16 bits of steps.
  localparam int unsigned SUM_W = CODE_W + 2;
  localparam logic [CODE_W-1:0] MOST = CODE_W'(32767);

  logic [5:0][CODE_W-1:0]  steps, steps_q, codes;
  logic [2:0][CODE_W-1:0]  origin_q;
  for (genvar k = 0; k < 6; k++) begin : g_steps
    localparam int unsigned AXIS = 2 - k % 3;
    logic [PRODUCT_W-1:0] w;
    assign w = PRODUCT_W'({planes_i[k], 1'b0}) + (halves_i[AXIS] ? PRODUCT_W'(planes_i[k]) : '0);
    box_steps #(.W(PRODUCT_W)) u_steps (.w_i(w), .exponent_i(exponents_i[AXIS]), .steps_o(steps[k]));
  end

  logic             valid_steps, ready_steps;
  logic [TAG_W-1:0] tag_steps;
  pipe_stage #(.W(9 * CODE_W + TAG_W)) u_steps (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({origin_i, steps, tag_i}),
    .valid_o(valid_steps), .ready_i(ready_steps), .data_o({origin_q, steps_q, tag_steps})
  );

  for (genvar k = 0; k < 6; k++) begin : g_code
    logic signed [CODE_W-1:0] origin;
    logic signed [SUM_W-1:0]  sum;
    assign origin   = origin_q[k%3];
    assign sum      = SUM_W'(origin) + {2'd0, steps_q[k]};
    // Above 32767; it is never below -32767.
    assign codes[k] = !sum[SUM_W-1] && sum[SUM_W-2:CODE_W-1] != '0 ? MOST : sum[CODE_W-1:0];
  end
  pipe_stage #(.W(6 * CODE_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_steps), .ready_o(ready_steps), .data_i({codes, tag_steps}),
    .valid_o, .ready_i, .data_o({bounds_o, tag_o})
  );

endmodule

`default_nettype wire
