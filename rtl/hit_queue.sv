`default_nettype none

/// First in, first out: hits on their way from the triangle test to the division.
///
/// `data_o` is the oldest item, valid while `empty_o` is low; a pop drops it at the end of the cycle. An item pushed is seen from the next cycle on. The caller never has
/// more than `DEPTH` items under way, so there is no full flag. A memory with one write and one clocked read port, never at the same place in one cycle: with a pop the item behind is read if there is one, and one
/// that finds nothing before it is kept beside the memory too. Only pointers and length are reset.
module hit_queue #(
  parameter int unsigned W = 1,
  parameter int unsigned DEPTH = 4,
  parameter bit PARITY = 1'b0
) (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  lod_pkg::memory_test_t test_i,
  input  logic         push_i,
  input  logic [W-1:0] data_i,
  input  logic         pop_i,
  output logic [W-1:0] data_o,
  output logic         empty_o,
  // A word that the memory changed is popped.
  output logic         fault_o
);

  if (DEPTH < 2) begin : g_illegal
    $error("hit_queue: DEPTH must be at least 2");
  end

  localparam int unsigned INDEX_W = $clog2(DEPTH);
  // 0 to DEPTH.
  localparam int unsigned LEN_W = $clog2(DEPTH + 1);
  localparam logic [INDEX_W-1:0] LAST = INDEX_W'(DEPTH - 1);

  logic [W-1:0]       read;
  logic [W-1:0]       direct_q;
  // The oldest item was never behind another.
  logic               is_direct_q;
  logic [INDEX_W-1:0] head_q;
  logic [INDEX_W-1:0] tail_q;
  logic [LEN_W-1:0]   len_q;
  logic [INDEX_W-1:0] behind;
  logic               direct;
  logic               reads;

  assign behind  = (head_q == LAST) ? '0 : head_q + INDEX_W'(1);
  assign direct  = empty_o || (pop_i && len_q == LEN_W'(1));
  assign reads   = pop_i && !direct;
  assign data_o  = is_direct_q ? direct_q : read;
  assign empty_o = len_q == '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      head_q <= '0;
      tail_q <= '0;
      len_q  <= '0;
    end else begin
      if (push_i) tail_q <= (tail_q == LAST) ? '0 : tail_q + INDEX_W'(1);
      if (pop_i) head_q <= behind;
      if (push_i && !pop_i) len_q <= len_q + LEN_W'(1);
      if (pop_i && !push_i) len_q <= len_q - LEN_W'(1);
    end
  end

  // On an FPGA not in block RAMs: few and wide.
  memory_1w1r #(.W(W), .WORDS(DEPTH), .DISTRIBUTED(1'b1), .PARITY(PARITY)) u_items (
    .clk_i, .test_i,
    .write_i(push_i), .write_place_i(tail_q), .data_i,
    .read_i(reads), .read_place_i(behind), .use_i(pop_i && !is_direct_q), .data_o(read), .fault_o
  );

  always_ff @(posedge clk_i) begin
    if (push_i && direct) direct_q <= data_i;
    if (pop_i || empty_o) is_direct_q <= direct;
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(push_i && !pop_i && len_q == LEN_W'(DEPTH)));
      assert (!(pop_i && empty_o));
      assert (!(push_i && reads && tail_q == behind));
    end
  end

endmodule

`default_nettype wire
