`default_nettype none

/// Address of a memory line of a record. Twin of src/block/node_address.rs.
///
/// With i = (4^level - 1) / 3 + index: base + first + i for one-line records, base + first + 2i + half for two-line ones, base + first + floor((i - 1) / 2) for halves
/// of lines, which begin at level 1. Records outside of trees have first and level 0. Legal: level < MAX_LEVELS; result below 2^36, which the size of the sections keeps. Latency NODE_ADDRESS_LATENCY = 2, interval 1.
module node_address #(
  parameter int unsigned TAG_W = 8
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic                       valid_i,
  output logic                       ready_o,
  input  lod_pkg::node_address_in_t  in_i,
  input  logic [TAG_W-1:0]           tag_i,
  output logic                       valid_o,
  input  logic                       ready_i,
  output lod_pkg::node_address_out_t out_o,
  output logic [TAG_W-1:0]           tag_o
);

  localparam int unsigned ADDRESS_W = lod_pkg::LINE_ADDRESS_W;
  // (4^(MAX_LEVELS - 1) - 1) / 3: two bits a level, the last of them 0. With a 28-bit index: 29 bits; doubled: 30.
  localparam int unsigned START_W = 2 * (lod_pkg::MAX_LEVELS - 1);
  localparam int unsigned RECORD_W = 29;
  localparam int unsigned LINE_W = RECORD_W + 1;
  if (lod_pkg::NODE_ADDRESS_LATENCY != 2) begin : g_illegal_latency
    $error("node_address: lod_pkg::NODE_ADDRESS_LATENCY must be 2");
  end

  // (4^level - 1) / 3 in binary: 01 for each level below.
  logic [START_W-1:0]  start;
  logic [27:0]         index;
  logic [RECORD_W-1:0] record;
  logic [LINE_W-1:0]   line;
  always_comb begin
    start = '0;
    for (int unsigned k = 0; k < START_W / 2; k++) start[2*k] = in_i.level > 4'(k);
    // That number is odd: without its lowest one, and halved, the sum rounds down as the index does.
    if (in_i.halves) start = start >> 1;
  end
  assign index  = in_i.halves ? in_i.index >> 1 : in_i.index;
  assign record = RECORD_W'(start) + RECORD_W'(index);
  assign line   = in_i.pair ? {record, in_i.half} : {1'b0, record};

  logic                 valid_line, ready_line;
  logic [LINE_W-1:0]    line_q;
  logic [ADDRESS_W-1:0] base, base_q, address;
  logic [TAG_W-1:0]     tag_line;
  // No carry: the tree's lines have addresses.
  assign base = in_i.base + ADDRESS_W'(in_i.first);
  pipe_stage #(.W(LINE_W + ADDRESS_W + TAG_W)) u_line (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({line, base, tag_i}),
    .valid_o(valid_line), .ready_i(ready_line), .data_o({line_q, base_q, tag_line})
  );

  assign address = base_q + ADDRESS_W'(line_q);
  pipe_stage #(.W(ADDRESS_W + TAG_W)) u_address (
    .clk_i, .rst_ni, .valid_i(valid_line), .ready_o(ready_line), .data_i({address, tag_line}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
