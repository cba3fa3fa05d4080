`default_nettype none

/// What a unit did since its counters were cleared, for who tunes or debugs it: events in, counts modulo 2^32 out. Nothing in the unit depends on them.
///
/// `asks_i`: some context asks for that block or port; `grants_i`: one is served. Of both the bits are those of `taken` and `refused` in `unit_counters_t`.
module unit_counters (
  input  logic                        clk_i,
  input  logic                        rst_ni,
  input  logic                        clear_i,
  input  logic                        busy_i,
  input  logic                        ray_valid_i,
  input  logic                        ray_ready_i,
  input  logic                        hit_valid_i,
  input  logic                        hit_ready_i,
  input  logic                        hit_found_i,
  input  logic                        hit_error_i,
  input  logic                        request_valid_i,
  input  logic                        request_ready_i,
  input  logic                        answer_valid_i,
  input  logic                        compared_i,
  input  logic [9:0]                  asks_i,
  input  logic [9:0]                  grants_i,
  output lod_pkg::unit_counters_t     counters_o
);

  lod_pkg::unit_counters_t counters_q, counters;
  assign counters_o = counters_q;

  always_comb begin
    counters          = counters_q;
    counters.cycles   = counters_q.cycles + 32'd1;
    counters.busy     = counters_q.busy + 32'(busy_i);
    counters.rays     = counters_q.rays + 32'(ray_valid_i && ray_ready_i);
    counters.hits     = counters_q.hits + 32'(hit_valid_i && hit_ready_i && hit_found_i);
    counters.misses   = counters_q.misses + 32'(hit_valid_i && hit_ready_i && !hit_found_i && !hit_error_i);
    counters.errors   = counters_q.errors + 32'(hit_valid_i && hit_ready_i && hit_error_i);
    counters.requests = counters_q.requests + 32'(request_valid_i && request_ready_i);
    counters.answers  = counters_q.answers + 32'(answer_valid_i);
    counters.compared = counters_q.compared + 32'(compared_i);
    counters.rays_wait     = counters_q.rays_wait + 32'(ray_valid_i && !ray_ready_i);
    counters.hits_wait     = counters_q.hits_wait + 32'(hit_valid_i && !hit_ready_i);
    counters.requests_wait = counters_q.requests_wait + 32'(request_valid_i && !request_ready_i);
    for (int unsigned k = 0; k < 10; k++) begin
      counters.taken[k]   = counters_q.taken[k] + 32'(grants_i[k]);
      counters.refused[k] = counters_q.refused[k] + 32'(asks_i[k] && !grants_i[k]);
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni || clear_i) counters_q <= '0;
    else counters_q <= counters;
  end

endmodule

`default_nettype wire
