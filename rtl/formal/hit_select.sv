`default_nettype none

/// The order of hits.

/// Two hits, each compared with the other as the closest so far: nearer first, at equal t a front face before a back face, then the smaller id, which is that of the first full-resolution triangle.
/// So exactly one is closer unless they are the same triangle, whichever comes first; and any hit is closer than none.
module hit_select_order (
  input logic                                clk_i,
  input logic                                rst_ni,
  input logic [3:0]                          levels_i,
  input logic                                known_i,
  input logic [1:0][lod_pkg::RAY_T_W-1:0]    t_i,
  input logic [1:0]                          front_i,
  input logic [1:0][27:0]                    tree_i,
  input logic [1:0][3:0]                     level_i,
  input logic [1:0][lod_pkg::NODE_INDEX_W-1:0] node_i
);

  logic [1:0]                            closer, legal;
  logic [1:0][lod_pkg::FULL_ID_W-1:0]    id, out_id;
  logic [1:0][lod_pkg::RAY_T_W+lod_pkg::FULL_ID_W:0] key;
  for (genvar k = 0; k < 2; k++) begin : g_hit
    lod_pkg::hit_select_in_t  in;
    lod_pkg::hit_select_out_t out;
    assign id[k]    = (lod_pkg::FULL_ID_W'(tree_i[k]) << 2 * levels_i) + (lod_pkg::FULL_ID_W'(node_i[k]) << 2 * (levels_i - level_i[k]));
    assign key[k]   = {t_i[k], !front_i[k], id[k]};
    assign legal[k] = level_i[k] <= levels_i && node_i[k] >> 2 * level_i[k] == '0;
    assign in       = {levels_i, known_i, t_i[1-k], front_i[1-k], id[1-k], t_i[k], front_i[k], tree_i[k], level_i[k], node_i[k]};
    assign {closer[k], out_id[k]} = out;
    hit_select #(.TAG_W(1)) u_select (
      .clk_i, .rst_ni, .valid_i(1'b1), .ready_o(), .in_i(in), .tag_i(1'b0), .valid_o(), .ready_i(1'b1), .out_o(out), .tag_o()
    );
  end

  always_comb begin
    assume (levels_i <= 4'd10 && legal == '1);
    assert (out_id == id);
    assert (closer[0] == (!known_i || key[0] < key[1]));
    assert (closer[1] == (!known_i || key[1] < key[0]));
    assert (!known_i || closer != '1);
    assert (!known_i || closer != '0 || (t_i[0] == t_i[1] && front_i[0] == front_i[1] && id[0] == id[1]));
    // Of two at one t the back face never wins.
    assert (!known_i || t_i[0] != t_i[1] || !front_i[0] || front_i[1] || closer == 2'b01);
    cover (known_i && t_i[0] == t_i[1] && front_i == 2'b01 && id[0] > id[1] && closer == 2'b01);
    cover (known_i && t_i[0] == t_i[1] && front_i == 2'b11 && tree_i[0] == tree_i[1] && closer == 2'b10);
    cover (known_i && id[0] == id[1] && level_i[0] != level_i[1] && closer == '0);
    cover (!known_i && closer == '1);
  end

endmodule

`default_nettype wire
