`default_nettype none

/// What stands at the ports of `traversal_unit` keeps the rules of docs/integration.md, checked in every simulation: bound to every unit, in no netlist.
///
/// Of its surroundings: a ray and the scene stand still as they must, answers come to requests, and none of those made before a reset comes behind it. Of the unit:
/// what is offered stands still, no tag is asked for twice, each ray gives one hit, which is an error or a result, and it is busy until then.
module traversal_unit_rules (
  input logic                     clk_i,
  input logic                     rst_ni,
  input lod_pkg::scene_config_t   scene_i,
  input logic                     busy_o,
  input logic                     valid_i,
  input logic                     ready_o,
  input lod_pkg::ray_in_t         in_i,
  input lod_pkg::secondary_in_t   secondary_i,
  input logic                     valid_o,
  input logic                     ready_i,
  input lod_pkg::hit_out_t        out_o,
  input lod_pkg::corners_t        corners_o,
  input logic                     mem_valid_o,
  input logic                     mem_ready_i,
  input lod_pkg::memory_request_t mem_o,
  input logic                     mem_valid_i,
  input logic                     mem_ready_o,
  // Tag and epoch.
  input logic [15:0]              answer_tag_i
);

  // What stood at the ports in the cycle before and was not taken.
  logic                     ray_waits_q, hit_waits_q, request_waits_q;
  lod_pkg::ray_in_t         ray_q;
  lod_pkg::secondary_in_t   secondary_q;
  lod_pkg::hit_out_t        hit_q;
  lod_pkg::corners_t        corners_q;
  lod_pkg::memory_request_t request_q;
  lod_pkg::scene_config_t   scene_q;
  // Rays taken whose hits were not, and by tag the epochs that an answer is due for, also one that never comes.
  logic [31:0]              rays_q;
  logic [255:0]             due_q [256];
  // How many of these there are.
  logic [31:0]              answers_due_q;
  // The epoch of the ray that each context asked for last, and the tags of that ray without an answer.
  logic [63:0][7:0]         epochs_q;
  logic [255:0]             asked_q;
  logic                     new_ray;
  assign new_ray = mem_o.epoch != epochs_q[mem_o.tag[7:2]];

  always_ff @(posedge clk_i) begin
    {ray_q, hit_q, request_q, scene_q} <= {in_i, out_o, mem_o, scene_i};
    {secondary_q, corners_q}           <= {secondary_i, corners_o};
    if (!rst_ni) begin
      {ray_waits_q, hit_waits_q, request_waits_q} <= '0;
      rays_q <= '0;
      for (int unsigned k = 0; k < 256; k++) due_q[k] <= '0;
      epochs_q <= '0;
      asked_q <= '0;
      answers_due_q <= '0;
    end else begin
      answers_due_q <= answers_due_q + 32'(mem_valid_o && mem_ready_i && !due_q[mem_o.tag][mem_o.epoch])
                     - 32'(mem_valid_i && mem_ready_o && due_q[answer_tag_i[15:8]][answer_tag_i[7:0]]);
      {ray_waits_q, hit_waits_q, request_waits_q} <= {valid_i && !ready_o, valid_o && !ready_i, mem_valid_o && !mem_ready_i};
      rays_q <= rays_q + 32'(valid_i && ready_o) - 32'(valid_o && ready_i);
      if (mem_valid_i && mem_ready_o) due_q[answer_tag_i[15:8]][answer_tag_i[7:0]] <= 1'b0;
      if (mem_valid_i && mem_ready_o && answer_tag_i[7:0] == epochs_q[answer_tag_i[15:10]]) asked_q[answer_tag_i[15:8]] <= 1'b0;
      if (mem_valid_o && mem_ready_i) begin
        due_q[mem_o.tag][mem_o.epoch] <= 1'b1;
        epochs_q[mem_o.tag[7:2]] <= mem_o.epoch;
        if (new_ray) asked_q[{mem_o.tag[7:2], 2'd0} +: 4] <= '0;
        asked_q[mem_o.tag] <= 1'b1;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!ray_waits_q || (valid_i && in_i == ray_q && (lod_pkg::SECONDARY == 0 || secondary_i == secondary_q))) else $error("in_i: a ray was withdrawn or changed before it was taken");
      assert (!hit_waits_q || (valid_o && out_o == hit_q && corners_o == corners_q)) else $error("out_o: a hit was withdrawn or changed before it was taken");
      assert (!request_waits_q || (mem_valid_o && mem_o == request_q)) else $error("mem_o: a request was withdrawn or changed before it was taken");
      assert (!busy_o || scene_i == scene_q) else $error("scene_i: it changed while a ray was under way");
      assert (!(valid_i && ready_o) || scene_i == scene_q) else $error("scene_i: it changed in the cycle in which a ray was taken");
      assert (!mem_valid_i || due_q[answer_tag_i[15:8]][answer_tag_i[7:0]]) else $error("mem_i: an answer without a request, or to one from before a reset");
      assert (!mem_valid_o || new_ray || !asked_q[mem_o.tag]) else $error("mem_o: a tag that the same ray waits for");
      assert (!valid_o || rays_q != '0) else $error("out_o: a hit of no ray");
      assert (!valid_o || out_o.error == '0 || (!out_o.found && out_o.hit == '0)) else $error("out_o: an error with a hit");
      assert (busy_o == (rays_q != '0 || mem_valid_o)) else $error("busy_o: high without a ray or a request, or low with one");
      // Contexts that rest take none until the lines that they are owed have come.
      assert (busy_o || ready_o || answers_due_q != '0) else $error("busy_o: low while no ray would be taken");
    end
  end

endmodule

bind traversal_unit traversal_unit_rules u_rules (
  .clk_i, .rst_ni, .scene_i, .busy_o, .valid_i, .ready_o, .in_i, .secondary_i, .valid_o, .ready_i, .out_o, .corners_o, .mem_valid_o, .mem_ready_i, .mem_o, .mem_valid_i, .mem_ready_o,
  .answer_tag_i({mem_i.tag, mem_i.epoch})
);

`default_nettype wire
