`default_nettype none

/// Displacement bound from its 8-bit code on a logarithmic scale. Twin of src/block/bound_decode.rs (paper section 4.3).
///
/// Code 0 gives 0; else, with k = code + offset, h = floor(M[k mod 16] 2^floor(k / 16) / 256) units and M[i] = 2^(i / 16) in steps of 1/256, rounded up.
/// Monotone in the code. Legal: any code; scales for which h is below 2^33. Latency BOUND_DECODE_LATENCY = 3; interval 1.
module bound_decode #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic                       valid_i,
  output logic                       ready_o,
  input  lod_pkg::bound_decode_in_t  in_i,
  input  logic [TAG_W-1:0]           tag_i,
  output logic                       valid_o,
  input  logic                       ready_i,
  output lod_pkg::bound_decode_out_t out_o,
  output logic [TAG_W-1:0]           tag_o
);

  localparam int unsigned H_W = lod_pkg::BOUND_W;
  // 8 and 9 bits added.
  localparam int unsigned K_W = lod_pkg::BOUND_SCALE_W + 1;
  localparam int unsigned MANTISSA_W = 9;
  localparam logic [16*MANTISSA_W-1:0] MANTISSAS = {
    9'd491, 9'd470, 9'd450, 9'd431, 9'd413, 9'd395, 9'd379, 9'd363, 9'd347, 9'd332, 9'd318, 9'd305, 9'd292, 9'd280, 9'd268, 9'd256
  };
  localparam int unsigned FRACTION_W = 8;
  // The shift to the left, up to 32: fine by up to 7, coarse by as many bytes as the other bits say, legally four.
  localparam int unsigned FINE_W = MANTISSA_W + 7;
  localparam int unsigned COARSE_W = H_W + FRACTION_W;
  if (lod_pkg::BOUND_DECODE_LATENCY != 3) begin : g_illegal_latency
    $error("bound_decode: lod_pkg::BOUND_DECODE_LATENCY must be 3");
  end

  logic             valid_k, ready_k, some_q;
  logic [K_W-1:0]   k, k_q;
  logic [TAG_W-1:0] tag_k;
  assign k = K_W'(in_i.code) + K_W'(in_i.scale.offset);
  pipe_stage #(.W(1 + K_W + TAG_W)) u_k (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({in_i.code != '0, k, tag_i}),
    .valid_o(valid_k), .ready_i(ready_k), .data_o({some_q, k_q, tag_k})
  );

  logic [MANTISSA_W-1:0] mantissa;
  always_comb begin
    mantissa = '0;
    for (int unsigned i = 0; i < 16; i++) if (k_q[3:0] == 4'(i)) mantissa = MANTISSAS[MANTISSA_W*i +: MANTISSA_W];
  end

  logic              valid_fine, ready_fine;
  logic [FINE_W-1:0] fine, fine_q;
  logic [K_W-8:0]    bytes_q;
  logic [TAG_W-1:0]  tag_fine;
  assign fine = some_q ? FINE_W'(mantissa) << k_q[6:4] : '0;
  pipe_stage #(.W(FINE_W + K_W - 7 + TAG_W)) u_fine (
    .clk_i, .rst_ni, .valid_i(valid_k), .ready_o(ready_k), .data_i({fine, k_q[K_W-1:7], tag_k}),
    .valid_o(valid_fine), .ready_i(ready_fine), .data_o({fine_q, bytes_q, tag_fine})
  );

  // Legal scales keep h below 2^33.
  logic [COARSE_W-1:0] coarse;
  assign coarse = COARSE_W'(fine_q) << {bytes_q, 3'd0};
  pipe_stage #(.W(H_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_fine), .ready_o(ready_fine), .data_i({coarse[COARSE_W-1:FRACTION_W], tag_fine}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

  logic unused_fraction;
  assign unused_fraction = ^coarse[FRACTION_W-1:0];

endmodule

`default_nettype wire
