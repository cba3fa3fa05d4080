`default_nettype none

/// What stands at the AXI ports of `axi_read_adapter` keeps the rules of AXI4 and of docs/integration.md, checked in every simulation: bound to every adapter, in no netlist.
///
/// Of the master: a request stands still until it is taken, is one whole line, crosses no 4 KB, and uses no id that is outstanding. Of the slave: beats come to requests alone, the last one
/// where it must be.
module axi_read_adapter_rules #(
  parameter int unsigned DATA_W = 256,
  parameter int unsigned ADDRESS_W = 64,
  parameter int unsigned READS = 8
) (
  input logic                               clk_i,
  input logic                               rst_ni,
  input logic [ADDRESS_W-1:0]               base_i,
  input logic                               mem_valid_i,
  input logic [lod_pkg::LINE_ADDRESS_W-1:0] line_i,
  input logic                               arvalid_i,
  input logic                               arready_i,
  input logic [$clog2(READS)-1:0]           arid_i,
  input logic [ADDRESS_W-1:0]               araddr_i,
  input logic [7:0]                         arlen_i,
  input logic [2:0]                         arsize_i,
  input logic [1:0]                         arburst_i,
  input logic                               rvalid_i,
  input logic                               rready_i,
  input logic [$clog2(READS)-1:0]           rid_i,
  input logic                               rlast_i
);

  localparam int unsigned ID_W = $clog2(READS);
  localparam int unsigned REQUEST_W = ID_W + ADDRESS_W + 8 + 3 + 2;
  localparam int unsigned LINE_BYTES = 32;
  localparam int unsigned PAGE_BYTES = 4096;
  localparam int unsigned SUM_W = 72;

  // What stood at the ports in the cycle before and was not taken; requests that beats are due for, and how many of each have come.
  logic                      waits_q, was_reset_q;
  logic [REQUEST_W-1:0]      request, request_q;
  logic [ADDRESS_W-1:0]      base_q;
  logic [(1<<ID_W)-1:0]      due_q;
  logic [(1<<ID_W)-1:0][7:0] lengths_q, beats_q;

  assign request = {arid_i, araddr_i, arlen_i, arsize_i, arburst_i};

  always_ff @(posedge clk_i) begin
    {request_q, base_q} <= {request, base_i};
    was_reset_q <= !rst_ni;
    if (!rst_ni) begin
      waits_q <= 1'b0;
      due_q <= '0;
    end else begin
      waits_q <= arvalid_i && !arready_i;
      if (rvalid_i && rready_i) begin
        beats_q[rid_i] <= beats_q[rid_i] + 8'd1;
        if (rlast_i) due_q[rid_i] <= 1'b0;
      end
      if (arvalid_i && arready_i) begin
        due_q[arid_i]     <= 1'b1;
        lengths_q[arid_i] <= arlen_i;
        beats_q[arid_i]   <= '0;
      end
    end
  end

  // Where a request ends within its page, and where the memory port's line ends.
  logic [31:0]      page_end;
  logic [SUM_W-1:0] line_end;

  assign page_end = 32'(araddr_i[11:0]) + ((32'(arlen_i) + 32'd1) << arsize_i);
  assign line_end = SUM_W'(base_i) + (SUM_W'(line_i) << 5) + SUM_W'(LINE_BYTES);

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!was_reset_q || !arvalid_i) else $error("ar: a request in the first cycle after reset");
      assert (!waits_q || (arvalid_i && request == request_q)) else $error("ar: a request was withdrawn or changed before it was taken");
      assert (!arvalid_i || page_end <= PAGE_BYTES) else $error("ar: a burst across 4 KB");
      assert (!arvalid_i || (arburst_i == 2'b01 && 32'(8) << arsize_i == DATA_W && (32'(arlen_i) + 32'd1) * DATA_W == 8 * LINE_BYTES)) else $error("ar: a burst that is not one line of full beats");
      assert (!arvalid_i || araddr_i[4:0] == '0) else $error("ar: a burst that does not begin where a line does");
      assert (!arvalid_i || 32'(arid_i) < READS) else $error("ar: an id that there is not");
      assert (!arvalid_i || !due_q[arid_i]) else $error("ar: an id that beats are due for");
      assert (!rvalid_i || due_q[rid_i]) else $error("r: a beat without a request");
      assert (!rvalid_i || !due_q[rid_i] || rlast_i == (beats_q[rid_i] == lengths_q[rid_i])) else $error("r: the last beat is not marked, or another is");
      assert (base_i[4:0] == '0 || !mem_valid_i) else $error("base_i: not a multiple of 32");
      assert (!mem_valid_i || base_i == base_q) else $error("base_i: it changed beside a request");
      assert (!mem_valid_i || line_end <= SUM_W'(1) << ADDRESS_W) else $error("mem_i: a line behind the last address of the bus");
    end
  end

endmodule

bind axi_read_adapter axi_read_adapter_rules #(.DATA_W(DATA_W), .ADDRESS_W(ADDRESS_W), .READS(READS)) u_rules (
  .clk_i, .rst_ni, .base_i, .mem_valid_i, .line_i(mem_i.address),
  .arvalid_i(axi_arvalid_o), .arready_i(axi_arready_i), .arid_i(axi_arid_o), .araddr_i(axi_araddr_o), .arlen_i(axi_arlen_o), .arsize_i(axi_arsize_o),
  .arburst_i(axi_arburst_o), .rvalid_i(axi_rvalid_i), .rready_i(axi_rready_o), .rid_i(axi_rid_i), .rlast_i(axi_rlast_i)
);

`default_nettype wire
