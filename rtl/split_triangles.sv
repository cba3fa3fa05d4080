`default_nettype none

/// The triangles of one ray on its way down a tree: the root's, and of each level that splits into nodes one with its inserted vertices.
///
/// Child k < 3 of a triangle has its corner k where it is, and two inserted vertices; child 3 has all three of these. So bank i holds corner i and inserted vertex i of each level, and a node's
/// triangle is one word of each bank: three narrow memories instead of one of twice their width, each with one write and one read port, never used in the same cycle.
/// `corners_o` is there from the cycle after `read_i`, as long as `child_i` stands still. A root is written with `root_write_i` and read with `root_i`, as its own child 3.
/// A node that splits is written in two cycles: its corners, which are those at `corners_o`, and its inserted vertices. No word is reset.
module split_triangles #(
  parameter int unsigned W = 1,
  parameter int unsigned LEVELS = 1,
  parameter bit PARITY = 1'b0
) (
  input  logic              clk_i,
  input  logic              rst_ni,
  input  lod_pkg::memory_test_t test_i,
  input  logic              root_write_i,
  input  logic [2:0][W-1:0] root_corners_i,
  input  logic              corners_write_i,
  input  logic              inserted_write_i,
  input  logic [3:0]        level_i,
  input  logic [2:0][W-1:0] inserted_i,
  input  logic              read_i,
  input  logic              root_i,
  input  logic [3:0]        parent_i,
  input  logic [1:0]        child_i,
  output logic [2:0][W-1:0] corners_o,
  // A word that a memory changed was read in the cycle before.
  output logic              fault_o
);

  localparam int unsigned ROOT = 2 * LEVELS;
  localparam int unsigned PLACES = ROOT + 1;
  localparam int unsigned PLACE_W = $clog2(PLACES);

  logic               write;
  logic [PLACE_W-1:0] write_place;
  logic [2:0][W-1:0]  written, words;
  logic [2:0]         faults;
  logic               used;

  assign write       = root_write_i || corners_write_i || inserted_write_i;
  assign write_place = root_write_i ? PLACE_W'(ROOT) : PLACE_W'({level_i, inserted_write_i});
  assign written     = root_write_i ? root_corners_i : inserted_write_i ? inserted_i : corners_o;

  if (PARITY) begin : g_used
    logic used_q;
    assign used = used_q;
    always_ff @(posedge clk_i) used_q <= rst_ni && read_i;
  end else begin : g_not_looked_at
    assign used = 1'b0;
  end
  assign fault_o = faults != '0;

  for (genvar k = 0; k < 3; k++) begin : g_bank
    logic [PLACE_W-1:0] read_place;

    assign read_place = root_i ? PLACE_W'(ROOT) : PLACE_W'({parent_i, child_i != 2'(k)});

    memory_1w1r #(.W(W), .WORDS(PLACES), .PARITY(PARITY)) u_words (
      .clk_i, .test_i,
      .write_i(write), .write_place_i(write_place), .data_i(written[k]),
      .read_i, .read_place_i(read_place), .use_i(used), .data_o(words[k]), .fault_o(faults[k])
    );
  end

  // The corner that stays is at its own place, and so are the vertices of child 3; the other two of a child change places.
  logic [W-1:0] corner0, corner1, corner2;
  assign corner0   = child_i == 2'd1 ? words[2] : child_i == 2'd2 ? words[1] : words[0];
  assign corner1   = child_i == 2'd0 ? words[2] : child_i == 2'd2 ? words[0] : words[1];
  assign corner2   = child_i == 2'd0 ? words[1] : child_i == 2'd1 ? words[0] : words[2];
  assign corners_o = {corner2, corner1, corner0};

  always_ff @(posedge clk_i) begin
    if (rst_ni) assert (32'(root_write_i) + 32'(corners_write_i) + 32'(inserted_write_i) + 32'(read_i) <= 1);
  end

endmodule

`default_nettype wire
