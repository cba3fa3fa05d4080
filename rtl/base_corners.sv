`default_nettype none

/// The corners of a base triangle in a memory line, as this hardware keeps them: of compact models an L0 record, of exact ones its second line, vertex data. Combinational.
module base_corners (
  input  logic                 compact_i,
  input  logic [255:0]         line_i,
  output lod_pkg::kept_point_t corner0_o,
  output lod_pkg::kept_point_t corner1_o,
  output lod_pkg::kept_point_t corner2_o
);

  localparam int unsigned COORDINATE_W = lod_pkg::POINT_W / 3;
  localparam int unsigned BASE_ZEROS = COORDINATE_W - lod_pkg::STORED_CORNER_W / 3;
  localparam int unsigned PADDING = COORDINATE_W - lod_pkg::STORED_POINT_W / 3;

  lod_pkg::l0_record_t                      record;
  lod_pkg::vertex_data_t                    vertices;
  logic [2:0][lod_pkg::STORED_CORNER_W-1:0] stored;
  logic [2:0][lod_pkg::STORED_POINT_W-1:0]  exact;
  logic                                     compact, unused_rest;
  assign record      = line_i;
  assign vertices    = line_i;
  assign stored      = {record.p2, record.p1, record.p0};
  assign exact       = {vertices.v2, vertices.v1, vertices.v0};
  assign compact     = lod_pkg::EXACT_VERTICES == 0 || (lod_pkg::COMPACT_VERTICES != 0 && compact_i);
  assign unused_rest = ^{compact_i, record, vertices};

  logic [2:0][lod_pkg::POINT_W-1:0] corners;
  for (genvar i = 0; i < 9; i++) begin : g_coordinate
    localparam int unsigned CORNER = i / 3;
    localparam int unsigned AXIS = i % 3;
    assign corners[CORNER][AXIS*COORDINATE_W +: COORDINATE_W] = compact
      ? {stored[CORNER][AXIS*(COORDINATE_W-BASE_ZEROS) +: COORDINATE_W-BASE_ZEROS], BASE_ZEROS'(0)}
      : {exact[CORNER][AXIS*(COORDINATE_W-PADDING) +: COORDINATE_W-PADDING], PADDING'(0)};
  end
  assign corner0_o = lod_pkg::keep_point(corners[0]);
  assign corner1_o = lod_pkg::keep_point(corners[1]);
  assign corner2_o = lod_pkg::keep_point(corners[2]);

endmodule

`default_nettype wire
