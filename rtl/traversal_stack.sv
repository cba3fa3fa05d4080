`default_nettype none

/// The traversal stack of one ray (paper figure 9): what is still to be visited, nearest on top.
///
/// `entry_o` is the top entry, valid while `empty_o` is low, but not in the cycle after a push: then there is no pop. A pop drops it at the end of the cycle. Push, pop and clear
/// exclude each other. A memory with one write and one clocked read port, which never work in the same cycle; the top is what was read last. Depth: `STACK_ENTRIES`, which a quad-BVH of
/// `MAX_BVH_DEPTH` levels and a tree of `STORED_LEVELS` cannot exceed (each level leaves at most three siblings waiting). Of deeper ones the caller stops at
/// `full_o`: then nothing may be pushed. Only the length is reset.
module traversal_stack #(
  parameter bit PARITY = 1'b0
) (
  input  logic                  clk_i,
  input  logic                  rst_ni,
  input  lod_pkg::memory_test_t test_i,
  input  logic                  clear_i,
  input  logic                  push_i,
  input  lod_pkg::stack_entry_t entry_i,
  input  logic                  pop_i,
  output lod_pkg::stack_entry_t entry_o,
  output logic                  empty_o,
  output logic                  full_o,
  // How many there are; a word that a memory changed is popped.
  output logic [$clog2(lod_pkg::STACK_ENTRIES+1)-1:0] length_o,
  output logic                  fault_o
);

  localparam int unsigned DEPTH = lod_pkg::STACK_ENTRIES;
  // 0 to DEPTH.
  localparam int unsigned LEN_W = $clog2(DEPTH + 1);
  localparam int unsigned INDEX_W = $clog2(DEPTH);

  logic [lod_pkg::KEPT_ENTRY_W-1:0] top_word;
  logic [LEN_W-1:0] len_q;
  logic [LEN_W-1:0] top;
  // Where the top is from the next cycle on, if nothing is pushed in this one.
  logic [INDEX_W-1:0] next_top;
  // What was read is no longer the top.
  logic stale_q;
  // The top is read: there is one, so that its place is one of the memory's.
  logic reads;

  assign top      = len_q - LEN_W'(1);
  assign reads    = !push_i && (pop_i ? top != '0 : stale_q && !empty_o);
  assign next_top = INDEX_W'(top) - INDEX_W'(pop_i);
  assign entry_o  = lod_pkg::whole_entry(top_word);
  assign empty_o  = len_q == '0;
  assign full_o   = len_q == LEN_W'(DEPTH);
  assign length_o = len_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) len_q <= '0;
    else if (clear_i) len_q <= '0;
    else if (push_i) len_q <= len_q + LEN_W'(1);
    else if (pop_i) len_q <= top;
  end

  // On an FPGA not in a block RAM: the top is compared before it is used.
  memory_1w1r #(.W(lod_pkg::KEPT_ENTRY_W), .WORDS(DEPTH), .DISTRIBUTED(1'b1), .PARITY(PARITY)) u_entries (
    .clk_i, .test_i,
    .write_i(push_i), .write_place_i(INDEX_W'(len_q)), .data_i(lod_pkg::keep_entry(entry_i)),
    .read_i(reads), .read_place_i(next_top), .use_i(pop_i), .data_o(top_word), .fault_o
  );

  always_ff @(posedge clk_i) stale_q <= push_i;

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (32'(push_i) + 32'(pop_i) + 32'(clear_i) <= 1);
      assert (!(push_i && full_o));
      assert (!(pop_i && empty_o));
      assert (!(pop_i && stale_q));
    end
  end

endmodule

`default_nettype wire
