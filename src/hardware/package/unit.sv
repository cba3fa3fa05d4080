
  // Kinds of stack entries.
  localparam logic [1:0] ENTRY_BVH_NODE = 2'd0;
  localparam logic [1:0] ENTRY_TREE = 2'd1;
  localparam logic [1:0] ENTRY_TREE_NODE = 2'd2;

  // What a division is for.
  localparam logic [1:0] DIVIDE_FOR_T = 2'd0;
  localparam logic [1:0] DIVIDE_FOR_V = 2'd1;
  localparam logic [1:0] DIVIDE_FOR_W = 2'd2;

  // Tags within the unit: a context's number, and two bits of a triangle's number or of a line's place; a division's has what it is for in front.
  localparam int unsigned PLACE_TAG_W = CONTEXT_W + 2;
  localparam int unsigned DIVIDE_TAG_W = 2 + PLACE_TAG_W;

  // A hit on its way to the closest.
  typedef struct packed {
    logic [CONTEXT_W-1:0] owner;  // Its context.
    logic [1:0] number;           // Which of the context's triangles.
    tri_test_out_t test;          // Its numerators.
  } queued_hit_t;
  localparam int unsigned QUEUED_HIT_W = CONTEXT_W + 2 + TRI_TEST_OUT_W;

endpackage

`default_nettype wire
