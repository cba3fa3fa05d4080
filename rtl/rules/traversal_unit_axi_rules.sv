`default_nettype none

/// `base_i` of `traversal_unit_axi` stands still as the rules of docs/integration.md say, checked in every simulation: bound to every such unit, in no netlist.
module traversal_unit_axi_rules #(
  parameter int unsigned ADDRESS_W = 64
) (
  input logic                 clk_i,
  input logic                 rst_ni,
  input logic [ADDRESS_W-1:0] base_i,
  input logic                 busy_i,
  input logic                 takes_i
);

  logic [ADDRESS_W-1:0] base_q;

  always_ff @(posedge clk_i) base_q <= base_i;

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!busy_i || base_i == base_q) else $error("base_i: it changed while a ray was under way");
      assert (!takes_i || base_i == base_q) else $error("base_i: it changed in the cycle in which a ray was taken");
    end
  end

endmodule

bind traversal_unit_axi traversal_unit_axi_rules #(.ADDRESS_W(ADDRESS_W)) u_rules (
  .clk_i, .rst_ni, .base_i, .busy_i(busy_o), .takes_i(valid_i && ready_o)
);

`default_nettype wire
