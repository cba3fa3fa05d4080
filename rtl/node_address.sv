`default_nettype none

/// Address of a memory line of a record. Twin of src/block/node_address.rs.
///
/// Record g = start + 4^level place + index, modulo 2^28, of 2^scale lines each: base + 2^scale g + low. Records outside of trees have start, place and level 0.
/// Legal: level <= 9, index < 4^level or place 0, low < 2^scale; result below 2^36, which the size of the sections keeps. Latency NODE_ADDRESS_LATENCY = 2, interval 1.
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
  localparam int unsigned RECORD_W = 28;
  localparam int unsigned LINE_W = RECORD_W + 1;
  if (lod_pkg::NODE_ADDRESS_LATENCY != 2) begin : g_illegal_latency
    $error("node_address: lod_pkg::NODE_ADDRESS_LATENCY must be 2");
  end

  logic [RECORD_W-1:0] record;
  logic [LINE_W-1:0]   line;
  // The index has no bits where the place has: no carry.
  assign record = in_i.start + ((in_i.place << {in_i.level, 1'b0}) | in_i.index);
  assign line   = (LINE_W'(record) << in_i.scale) | LINE_W'(in_i.low);

  logic                 valid_line, ready_line;
  logic [LINE_W-1:0]    line_q;
  logic [ADDRESS_W-1:0] base_q, address;
  logic [TAG_W-1:0]     tag_line;
  pipe_stage #(.W(LINE_W + ADDRESS_W + TAG_W)) u_line (
    .clk_i, .rst_ni, .valid_i, .ready_o, .data_i({line, in_i.base, tag_i}),
    .valid_o(valid_line), .ready_i(ready_line), .data_o({line_q, base_q, tag_line})
  );

  assign address = base_q + ADDRESS_W'(line_q);
  pipe_stage #(.W(ADDRESS_W + TAG_W)) u_address (
    .clk_i, .rst_ni, .valid_i(valid_line), .ready_o(ready_line), .data_i({address, tag_line}),
    .valid_o, .ready_i, .data_o({out_o, tag_o})
  );

endmodule

`default_nettype wire
