`default_nettype none

/// `traversal_unit` with its memory behind an AXI4 read master (`axi_read_adapter`): rays in, hits out, lines from `base_i` on.
///
/// Two reads outstanding a context, as many as its ray can ask for: only behind rays that ended early may requests wait for a place.
module traversal_unit_axi #(
  parameter int unsigned CONTEXTS = lod_pkg::CONTEXTS,
  parameter int unsigned EDGES_PER_CYCLE = lod_pkg::EDGES_PER_CYCLE,
  parameter int unsigned WATCH = 0,
  parameter int unsigned MEMORY_PARITY = 0,
  parameter int unsigned CLOCK_GATES = 0,
  parameter int unsigned DATA_W = 256,
  parameter int unsigned ADDRESS_W = 64
) (
  input  logic                          clk_i,
  input  logic                          rst_ni,
  input  lod_pkg::scene_config_t        scene_i,
  input  logic [ADDRESS_W-1:0]          base_i,
  input  logic                          flush_i,
  output logic                          busy_o,
  input  lod_pkg::memory_test_t         memory_test_i,
  output logic                          memory_fault_o,
  input  logic [5:0]                    view_context_i,
  output lod_pkg::context_view_t        view_o,
  input  logic                          counters_clear_i,
  output lod_pkg::unit_counters_t       counters_o,
  input  logic                          valid_i,
  output logic                          ready_o,
  input  lod_pkg::ray_in_t              in_i,
  input  lod_pkg::secondary_in_t        secondary_i,
  output logic                          valid_o,
  input  logic                          ready_i,
  output lod_pkg::hit_out_t             out_o,
  output lod_pkg::corners_t             corners_o,
  // Some read has no answer yet; an answer of this cycle had an error.
  output logic                          reads_busy_o,
  output logic                          read_error_o,
  output logic                          axi_arvalid_o,
  input  logic                          axi_arready_i,
  output logic [$clog2(2*CONTEXTS)-1:0] axi_arid_o,
  output logic [ADDRESS_W-1:0]          axi_araddr_o,
  output logic [7:0]                    axi_arlen_o,
  output logic [2:0]                    axi_arsize_o,
  output logic [1:0]                    axi_arburst_o,
  output logic [3:0]                    axi_arcache_o,
  output logic [2:0]                    axi_arprot_o,
  input  logic                          axi_rvalid_i,
  output logic                          axi_rready_o,
  input  logic [$clog2(2*CONTEXTS)-1:0] axi_rid_i,
  input  logic [DATA_W-1:0]             axi_rdata_i,
  input  logic [1:0]                    axi_rresp_i,
  input  logic                          axi_rlast_i
);

  logic request_valid, request_ready, answer_valid;
  lod_pkg::memory_request_t request;
  lod_pkg::memory_answer_t answer;

  traversal_unit #(
    .CONTEXTS(CONTEXTS), .EDGES_PER_CYCLE(EDGES_PER_CYCLE), .WATCH(WATCH), .MEMORY_PARITY(MEMORY_PARITY), .CLOCK_GATES(CLOCK_GATES)
  ) u_unit (
    .clk_i, .rst_ni, .scene_i, .flush_i, .busy_o,
    .memory_test_i, .memory_fault_o, .view_context_i, .view_o, .counters_clear_i, .counters_o,
    .valid_i, .ready_o, .in_i, .secondary_i,
    .valid_o, .ready_i, .out_o, .corners_o,
    .mem_valid_o(request_valid), .mem_ready_i(request_ready), .mem_o(request),
    .mem_valid_i(answer_valid), .mem_ready_o(), .mem_i(answer)
  );

  axi_read_adapter #(.DATA_W(DATA_W), .ADDRESS_W(ADDRESS_W), .READS(2 * CONTEXTS)) u_adapter (
    .clk_i, .rst_ni, .base_i, .busy_o(reads_busy_o),
    .mem_valid_i(request_valid), .mem_ready_o(request_ready), .mem_i(request),
    .mem_valid_o(answer_valid), .mem_o(answer),
    .axi_arvalid_o, .axi_arready_i, .axi_arid_o, .axi_araddr_o, .axi_arlen_o, .axi_arsize_o, .axi_arburst_o, .axi_arcache_o, .axi_arprot_o,
    .axi_rvalid_i, .axi_rready_o, .axi_rid_i, .axi_rdata_i, .axi_rresp_i, .axi_rlast_i
  );

  assign read_error_o = answer_valid && answer.error;

endmodule

`default_nettype wire
