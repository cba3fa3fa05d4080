`default_nettype none

/// From the memory port of `traversal_unit` to an AXI4 read master: each line is a burst of 32 bytes at `base_i` + 32 times its address.
///
/// An id is the number of one of `READS` places, which keeps the unit's tag and epoch from the request to the last beat of its answer: so ids are dense, none is outstanding twice, and
/// answers may come in any order, beats of different ids in turns; one of which a beat is no OKAY is an error. Requests wait while all places are taken; answers are taken always, and go on one cycle after their last beat.
/// A line begins at a multiple of its length, so no burst crosses 4 KB. Every output comes from registers alone. What an interconnect must do: docs/integration.md.
module axi_read_adapter #(
  parameter int unsigned DATA_W = 256,
  parameter int unsigned ADDRESS_W = 64,
  parameter int unsigned READS = 2 * lod_pkg::CONTEXTS,
  // Memory type and protection of every read: normal and not cacheable, unprivileged and not secure.
  parameter logic [3:0] CACHE = 4'b0011,
  parameter logic [2:0] PROT = 3'b010
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  // Byte address of line 0, a multiple of 32; held still from the cycle before a request until it is taken.
  input  logic [ADDRESS_W-1:0]     base_i,
  // Some read has no answer yet: no reset of this side alone.
  output logic                     busy_o,
  input  logic                     mem_valid_i,
  output logic                     mem_ready_o,
  input  lod_pkg::memory_request_t mem_i,
  output logic                     mem_valid_o,
  output lod_pkg::memory_answer_t  mem_o,
  output logic                     axi_arvalid_o,
  input  logic                     axi_arready_i,
  output logic [$clog2(READS)-1:0] axi_arid_o,
  output logic [ADDRESS_W-1:0]     axi_araddr_o,
  output logic [7:0]               axi_arlen_o,
  output logic [2:0]               axi_arsize_o,
  output logic [1:0]               axi_arburst_o,
  output logic [3:0]               axi_arcache_o,
  output logic [2:0]               axi_arprot_o,
  input  logic                     axi_rvalid_i,
  output logic                     axi_rready_o,
  input  logic [$clog2(READS)-1:0] axi_rid_i,
  input  logic [DATA_W-1:0]        axi_rdata_i,
  input  logic [1:0]               axi_rresp_i,
  input  logic                     axi_rlast_i
);

  if (DATA_W != 256 && DATA_W != 128 && DATA_W != 64 && DATA_W != 32) begin : g_illegal_data
    $error("axi_read_adapter: DATA_W = %0d, must be 256, 128, 64 or 32", DATA_W);
  end
  if (ADDRESS_W < 12 || ADDRESS_W > 64) begin : g_illegal_address
    $error("axi_read_adapter: ADDRESS_W = %0d, must be 12 to 64", ADDRESS_W);
  end
  if (READS < 2 || READS > 256) begin : g_illegal_reads
    $error("axi_read_adapter: READS = %0d, must be 2 to 256", READS);
  end

  // A line's bytes as a power of two, and its bits.
  localparam int unsigned LINE_SHIFT = 5;
  localparam int unsigned LINE_W = 8 << LINE_SHIFT;
  localparam int unsigned BEATS = LINE_W / DATA_W;
  localparam int unsigned ID_W = $clog2(READS);
  localparam int unsigned TAG_W = lod_pkg::MEMORY_REQUEST_W - lod_pkg::LINE_ADDRESS_W;
  localparam int unsigned NUMBER_W = ADDRESS_W - LINE_SHIFT;

  // ---- Places: the lowest free one takes a request ----

  logic [READS-1:0] taken_q, first_free, take, done;
  logic [ID_W-1:0]  place;
  logic             some_free, last;

  assign first_free = ~taken_q & (taken_q + READS'(1));
  assign some_free  = taken_q != '1;
  assign last       = axi_rvalid_i && axi_rlast_i;
  assign take       = mem_valid_i && mem_ready_o ? first_free : '0;
  assign done       = last ? READS'(1) << axi_rid_i : '0;
  assign busy_o     = taken_q != '0;

  always_comb begin
    place = '0;
    for (int unsigned k = 0; k < READS; k++) begin
      if (first_free[k]) place = place | ID_W'(k);
    end
  end

  logic [TAG_W-1:0] tags_q [READS];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) taken_q <= '0;
    else taken_q <= (taken_q | take) & ~done;
  end

  always_ff @(posedge clk_i) begin
    if (mem_valid_i && some_free) tags_q[place] <= {mem_i.tag, mem_i.epoch};
  end

  // ---- Requests ----

  logic [NUMBER_W-1:0] number, number_q;
  logic                request_ready;

  // What an address has above the bus is dropped, and so is what a base has below a line.
  assign number      = base_i[ADDRESS_W-1:LINE_SHIFT] + NUMBER_W'(mem_i.address);
  assign mem_ready_o = request_ready && some_free;
  logic [LINE_SHIFT-1:0] unused_base;
  assign unused_base = base_i[LINE_SHIFT-1:0];

  pipe_skid #(.W(ID_W + NUMBER_W)) u_request (
    .clk_i, .rst_ni,
    .valid_i(mem_valid_i && some_free), .ready_o(request_ready), .data_i({place, number}),
    .valid_o(axi_arvalid_o), .ready_i(axi_arready_i), .data_o({axi_arid_o, number_q})
  );

  assign axi_araddr_o  = {number_q, LINE_SHIFT'(0)};
  assign axi_arlen_o   = 8'(BEATS - 1);
  assign axi_arsize_o  = 3'($clog2(DATA_W / 8));
  assign axi_arburst_o = 2'b01;
  assign axi_arcache_o = CACHE;
  assign axi_arprot_o  = PROT;

  // ---- Answers: beats of a place move down until its last one is there, the first in the lowest bytes ----

  logic [READS-1:0]  wrong_q, wrong;
  logic [LINE_W-1:0] line;

  assign axi_rready_o = 1'b1;
  assign wrong        = axi_rvalid_i && axi_rresp_i != 2'b00 ? READS'(1) << axi_rid_i : '0;

  if (BEATS == 1) begin : g_beat
    assign line = axi_rdata_i;
  end else begin : g_beats
    logic [LINE_W-DATA_W-1:0] beats_q [READS];

    assign line = {axi_rdata_i, beats_q[axi_rid_i]};

    always_ff @(posedge clk_i) begin
      if (axi_rvalid_i) beats_q[axi_rid_i] <= line[LINE_W-1:DATA_W];
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      mem_valid_o <= 1'b0;
      wrong_q     <= '0;
    end else begin
      mem_valid_o <= last;
      wrong_q     <= (wrong_q | wrong) & ~done;
    end
  end

  logic error;
  assign error = ((wrong_q | wrong) & done) != '0;

  always_ff @(posedge clk_i) begin
    mem_o <= {tags_q[axi_rid_i], error, line};
  end

endmodule

`default_nettype wire
