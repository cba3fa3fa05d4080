`default_nettype none

/// A memory of one write port and one read port with a clock, never used at the same place in one cycle; what was read last stays at the output. The one place for a compiled memory: nothing
/// else in the unit is an array that is read with a clock.
///
/// `test_i.pins` are for a macro's margins and modes, and mean nothing here. With `PARITY` each word has a bit more; `fault_o` is high in a cycle in which a word with the wrong
/// one is used (`use_i`), and `test_i.flip` writes wrong ones, so that who looks at `fault_o` can be tried in silicon.
/// `DISTRIBUTED`: on an FPGA not in a block RAM, what comes out of which comes late. Nothing is reset.
module memory_1w1r #(
  parameter int unsigned W = 1,
  parameter int unsigned WORDS = 2,
  parameter bit DISTRIBUTED = 1'b0,
  parameter bit PARITY = 1'b0
) (
  input  logic                     clk_i,
  input  lod_pkg::memory_test_t    test_i,
  input  logic                     write_i,
  input  logic [$clog2(WORDS)-1:0] write_place_i,
  input  logic [W-1:0]             data_i,
  input  logic                     read_i,
  input  logic [$clog2(WORDS)-1:0] read_place_i,
  input  logic                     use_i,
  output logic [W-1:0]             data_o,
  output logic                     fault_o
);

  localparam int unsigned WORD_W = W + 32'(PARITY);

  logic [WORD_W-1:0] written, word_q;

  assign written = WORD_W'({test_i.flip ^ (^data_i), data_i});
  assign data_o  = word_q[W-1:0];

  logic unused_pins;
  assign unused_pins = ^test_i.pins;

  if (PARITY) begin : g_parity
    assign fault_o = use_i && (^word_q);
  end else begin : g_no_parity
    logic unused_use;
    assign unused_use = use_i;
    assign fault_o    = 1'b0;
  end

  if (DISTRIBUTED) begin : g_distributed
    (* ram_style = "distributed" *)
    logic [WORD_W-1:0] words_q [WORDS];
    always_ff @(posedge clk_i) begin
      if (write_i) words_q[write_place_i] <= written;
      if (read_i) word_q <= words_q[read_place_i];
    end
  end else begin : g_any
    logic [WORD_W-1:0] words_q [WORDS];
    always_ff @(posedge clk_i) begin
      if (write_i) words_q[write_place_i] <= written;
      if (read_i) word_q <= words_q[read_place_i];
    end
  end

endmodule

`default_nettype wire
