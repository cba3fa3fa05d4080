`default_nettype none

/// What stands at the ports of `traversal_unit` keeps the rules of docs/integration.md, checked in every simulation: bound to every unit, in no netlist.
///
/// Of its surroundings: a ray and the scene stand still as they must, answers come to requests. Of the unit: what is offered stands still, no tag is asked for twice.
module traversal_unit_rules (
  input logic                     clk_i,
  input logic                     rst_ni,
  input lod_pkg::scene_config_t   scene_i,
  input logic                     valid_i,
  input logic                     ready_o,
  input lod_pkg::ray_in_t         in_i,
  input logic                     valid_o,
  input logic                     ready_i,
  input lod_pkg::hit_out_t        out_o,
  input logic                     mem_valid_o,
  input logic                     mem_ready_i,
  input lod_pkg::memory_request_t mem_o,
  input logic                     mem_valid_i,
  input logic                     mem_ready_o,
  input logic [7:0]               answer_tag_i,
  // Some ray is under way.
  input logic                     busy_i
);

  // What stood at the ports in the cycle before and was not taken.
  logic                     ray_waits_q, hit_waits_q, request_waits_q, busy_q;
  lod_pkg::ray_in_t         ray_q;
  lod_pkg::hit_out_t        hit_q;
  lod_pkg::memory_request_t request_q;
  lod_pkg::scene_config_t   scene_q;
  // Tags that an answer is due for.
  logic [255:0]             due_q;

  always_ff @(posedge clk_i) begin
    {ray_q, hit_q, request_q, scene_q} <= {in_i, out_o, mem_o, scene_i};
    if (!rst_ni) begin
      {ray_waits_q, hit_waits_q, request_waits_q, busy_q} <= '0;
      due_q <= '0;
    end else begin
      {ray_waits_q, hit_waits_q, request_waits_q, busy_q} <= {valid_i && !ready_o, valid_o && !ready_i, mem_valid_o && !mem_ready_i, busy_i};
      if (mem_valid_i && mem_ready_o) due_q[answer_tag_i] <= 1'b0;
      if (mem_valid_o && mem_ready_i) due_q[mem_o.tag] <= 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!ray_waits_q || (valid_i && in_i == ray_q)) else $error("in_i: a ray was withdrawn or changed before it was taken");
      assert (!hit_waits_q || (valid_o && out_o == hit_q)) else $error("out_o: a hit was withdrawn or changed before it was taken");
      assert (!request_waits_q || (mem_valid_o && mem_o == request_q)) else $error("mem_o: a request was withdrawn or changed before it was taken");
      assert (!(busy_q && busy_i) || scene_i == scene_q) else $error("scene_i: it changed while a ray was under way");
      assert (!mem_valid_i || due_q[answer_tag_i]) else $error("mem_i: an answer without a request");
      assert (!mem_valid_o || !due_q[mem_o.tag]) else $error("mem_o: a tag that an answer is due for");
    end
  end

endmodule

bind traversal_unit traversal_unit_rules u_rules (
  .clk_i, .rst_ni, .scene_i, .valid_i, .ready_o, .in_i, .valid_o, .ready_i, .out_o, .mem_valid_o, .mem_ready_i, .mem_o, .mem_valid_i, .mem_ready_o,
  .answer_tag_i(mem_i.tag), .busy_i(idle != '1 || valid_o)
);

`default_nettype wire
