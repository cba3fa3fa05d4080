`default_nettype none

/// The box of a child for this ray: its stored box and its morphed triangle. Twin of src/block/widen_box.rs (paper section 3.4).
///
/// lo' = min(lo, floor(p / 2^16)), hi' = max(hi, ceil(p / 2^16)) over the three corners, in box codes from the start: floor and ceil are monotone.
/// Legal: |p| <= 0x7FFE_0000, so that the ceiling fits 16 bits. Its last register is a `pipe_skid`.
/// Latency WIDEN_BOX_LATENCY = 3, interval 1.
module widen_box #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  lod_pkg::widen_box_in_t  in_i,
  input  logic [TAG_W-1:0]        tag_i,
  output logic                    valid_o,
  input  logic                    ready_i,
  output lod_pkg::widen_box_out_t out_o,
  output logic [TAG_W-1:0]        tag_o
);

  localparam int unsigned CODE_W = lod_pkg::CODE3_W / 3;
  localparam int unsigned POINT_W = lod_pkg::POINT_W / 3;
  if (lod_pkg::WIDEN_BOX_LATENCY != 3) begin : g_illegal_latency
    $error("widen_box: lod_pkg::WIDEN_BOX_LATENCY must be 3");
  end

  // Per coordinate (z first, as structs lie): stored code and the corners.
  logic [2:0][CODE_W-1:0]  lo, hi;
  logic [2:0][POINT_W-1:0] a, b, c;
  assign {lo, hi} = in_i.bounds;
  assign {a, b, c} = {in_i.p0, in_i.p1, in_i.p2};

  // Stage 1: codes of the corners. Stages 2 and 3: the smaller and larger of pairs.
  logic [2:0][4*CODE_W-1:0] low_codes, low_q, high_codes, high_q;
  logic [2:0][2*CODE_W-1:0] low_pairs, low_pairs_q, high_pairs, high_pairs_q;
  logic [2:0][CODE_W-1:0]   low, high;
  for (genvar k = 0; k < 3; k++) begin : g_axis
    assign low_codes[k]  = {lo[k], a[k][31:16], b[k][31:16], c[k][31:16]};
    // A ceiling is the floor, plus 1 if anything was cut off: at most 32766 for legal corners.
    assign high_codes[k] = {hi[k], a[k][31:16] + CODE_W'(a[k][15:0] != '0), b[k][31:16] + CODE_W'(b[k][15:0] != '0),
                            c[k][31:16] + CODE_W'(c[k][15:0] != '0)};

    logic signed [CODE_W-1:0] l0, l1, l2, l3, h0, h1, h2, h3, m0, m1, n0, n1;
    assign {l0, l1, l2, l3} = low_q[k];
    assign {h0, h1, h2, h3} = high_q[k];
    assign low_pairs[k]     = {l0 < l1 ? l0 : l1, l2 < l3 ? l2 : l3};
    assign high_pairs[k]    = {h0 > h1 ? h0 : h1, h2 > h3 ? h2 : h3};
    assign {m0, m1}         = low_pairs_q[k];
    assign {n0, n1}         = high_pairs_q[k];
    assign low[k]           = m0 < m1 ? m0 : m1;
    assign high[k]          = n0 > n1 ? n0 : n1;
  end

  logic             valid_codes, ready_codes, valid_pairs, ready_pairs;
  logic [TAG_W-1:0] tag_codes, tag_pairs;
  pipe_stage #(.W(24 * CODE_W + TAG_W)) u_codes (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({low_codes, high_codes, tag_i}),
    .valid_o(valid_codes), .ready_i(ready_codes), .data_o({low_q, high_q, tag_codes})
  );
  pipe_stage #(.W(12 * CODE_W + TAG_W)) u_pairs (
    .clk_i, .rst_ni, .valid_i(valid_codes), .ready_o(ready_codes), .data_i({low_pairs, high_pairs, tag_codes}),
    .valid_o(valid_pairs), .ready_i(ready_pairs), .data_o({low_pairs_q, high_pairs_q, tag_pairs})
  );
  pipe_skid #(.W(6 * CODE_W + TAG_W)) u_out (
    .clk_i, .rst_ni, .valid_i(valid_pairs), .ready_o(ready_pairs), .data_i({low, high, tag_pairs}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
