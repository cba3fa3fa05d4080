`default_nettype none

/// What a context and the unit around it may rely on at the ports between them, in operations counted from grants and results.
///
/// Inside `ray_context` (OF_CONTEXT) the unit's part is assumed and the context's asserted; in `ray_context_stub`, inside `traversal_unit`, the other way round. That is no circle: the
/// unit's part speaks of inputs that may always be low and so excludes no state; the context's is made of registers alone.
/// Memory keeps to nothing: lines come whenever they do, asked for or not.
module context_rules #(
  parameter bit OF_CONTEXT = 1
) (
  input  logic                        clk_i,
  input  logic                        rst_ni,
  input  logic                        idle_i,
  input  logic                        free_i,
  input  logic                        take_i,
  // Blocks in which a context has one operation at most: tree_deciders, ray_setup, child_test, lod_test, tessellate, bary_map; or, for rays from a surface, those in their places.
  input  logic [5:0]                  request_i,
  input  logic [5:0]                  grant_i,
  input  logic [5:0]                  valid_i,
  input  logic                        line_request_i,
  input  logic                        line_place_i,
  input  logic [lod_pkg::EPOCH_W-1:0] epoch_i,
  input  logic                        line_grant_i,
  input  logic                        line_valid_i,
  input  logic [1:0]                  line_valid_place_i,
  input  logic [lod_pkg::EPOCH_W-1:0] line_valid_epoch_i,
  input  logic                        tri_request_i,
  input  logic [1:0]                  tri_number_i,
  input  logic                        tri_grant_i,
  input  logic                        tri_miss_i,
  input  logic                        select_valid_i,
  input  logic                        divide_request_i,
  input  logic [1:0]                  divide_what_i,
  input  logic                        divide_grant_i,
  input  logic                        divide_valid_i,
  input  logic [1:0]                  divide_valid_what_i,
  input  logic                        hit_request_i,
  input  logic                        hit_grant_i,
  // Reset has been; which blocks have an operation of the context; lines asked for and not there, by place; triangles asked for and without a verdict; the divisions of v and w.
  output logic                        live_o,
  output logic [5:0]                  inside_o,
  output logic [1:0]                  asked_o,
  output logic [2:0]                  tested_o,
  output logic [3:0]                  numbers_o,
  output logic                        v_o,
  output logic                        w_o
);

  logic                        live_q, v_q, w_q;
  logic [5:0]                  inside_q;
  logic [1:0]                  asked_q, asks, comes;
  logic [2:0]                  tested_q;
  logic [3:0]                  numbers_q;  // of triangles given since there were none
  logic [lod_pkg::EPOCH_W-1:0] epoch_q;

  assign {live_o, inside_o, asked_o, tested_o, numbers_o, v_o, w_o} = {live_q, inside_q, asked_q, tested_q, numbers_q, v_q, w_q};
  assign asks  = line_grant_i ? 2'b01 << line_place_i : 2'b00;
  assign comes = line_valid_i && line_valid_epoch_i == epoch_i && !line_valid_place_i[1] ? (2'b01 << line_valid_place_i[0]) & asked_q : 2'b00;

  initial live_q = 1'b0;
  always_ff @(posedge clk_i) begin
    epoch_q <= epoch_i;
    if (!rst_ni) begin
      live_q <= 1'b1;
      {inside_q, asked_q, tested_q, numbers_q, v_q, w_q} <= '0;
      epoch_q <= '0;
    end else begin
      inside_q <= (inside_q | grant_i) & ~valid_i;
      // A new ray has asked for nothing: ray_setup's result begins its epoch.
      asked_q  <= valid_i[4] ? '0 : (asked_q | asks) & ~comes;
      tested_q <= tested_q + 3'(tri_grant_i) - 3'(tri_miss_i) - 3'(select_valid_i);
      if (tri_grant_i) numbers_q <= (tested_q == '0 ? 4'd0 : numbers_q) | 4'd1 << tri_number_i;
      v_q      <= (v_q || (divide_grant_i && divide_what_i == lod_pkg::DIVIDE_FOR_V)) && !(divide_valid_i && divide_valid_what_i == lod_pkg::DIVIDE_FOR_V);
      w_q      <= (w_q || (divide_grant_i && divide_what_i == lod_pkg::DIVIDE_FOR_W)) && !(divide_valid_i && divide_valid_what_i == lod_pkg::DIVIDE_FOR_W);
    end
  end

  // A grant answers a request, a result an operation inside, and rays come to free contexts.
  logic unit_keeps;
  assign unit_keeps = (grant_i & ~request_i) == '0 && (valid_i & ~inside_q) == '0 && (!take_i || free_i)
                   && (!line_grant_i || line_request_i) && (!tri_grant_i || tri_request_i) && (!divide_grant_i || divide_request_i) && (!hit_grant_i || hit_request_i)
                   && 3'(tri_miss_i) + 3'(select_valid_i) <= tested_q
                   && (!divide_valid_i || ((divide_valid_what_i != lod_pkg::DIVIDE_FOR_V || v_q) && (divide_valid_what_i != lod_pkg::DIVIDE_FOR_W || (w_q && !v_q))));

  // One operation in each of those blocks.
  logic one_inside, one_line, four_triangles, two_divisions, ends_clean;
  assign one_inside     = (request_i & inside_q) == '0;
  // One line of each place; the epoch changes with a ray's setup alone.
  assign one_line       = !line_request_i || !asked_q[line_place_i];
  // Four triangles, each of another number.
  assign four_triangles = tested_q <= 3'd4 && (!tri_request_i || tested_q == '0 || !numbers_q[tri_number_i]);
  // One division for each barycentric, v before w, and neither while triangles are under way.
  assign two_divisions  = !divide_request_i || (tested_q == '0 && !w_q && (divide_what_i == lod_pkg::DIVIDE_FOR_W || (divide_what_i == lod_pkg::DIVIDE_FOR_V && !v_q)));
  // When its hit goes out, and before a ray comes in, no block has anything of a context; one that is free is idle.
  assign ends_clean     = (!free_i || idle_i) && (!(hit_request_i || idle_i) || (inside_q == '0 && tested_q == '0 && !v_q && !w_q));

  always_comb begin
    assume (live_q || !rst_ni);
    if (OF_CONTEXT) begin
      assume (!live_q || unit_keeps);
      if (live_q) begin
        assert (one_inside);
        assert (one_line);
        assert (four_triangles);
        assert (two_divisions);
        assert (ends_clean);
      end
    end else begin
      assume (!live_q || (one_inside && one_line && four_triangles && two_divisions && ends_clean));
      if (live_q) assert (unit_keeps);
    end
  end

endmodule

`default_nettype wire
