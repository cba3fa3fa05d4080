`default_nettype none

/// Drives a core with the rays of a picture, serves its memory from the scene's file, and checks each hit against the golden traverser, ray by ray.
///
/// The core here is this repository's `traversal_unit`. For one of your own put it in the place that is marked, and change how its ports map; if its hits have fewer fields,
/// compare those. Plus-arguments: +scene=FILE, and +width=N (32), +distance=REAL (2.5, in bounding radii), +delta=REAL (1), +latency=N (40 cycles of memory, at most as many),
/// +seed=N. `+break=N` makes the core's hit of ray N wrong, to see that the check looks.
module golden_check;

  // Without a hit, a request or an answer for so long the core hangs.
  localparam int unsigned PATIENCE = 20000;

  logic clk = 1'b0;
  logic rst_n = 1'b0;
  always #5 clk = ~clk;

  lod_pkg::scene_config_t   scene;
  logic                     ray_valid, ray_ready;
  lod_pkg::ray_in_t         ray;
  lod_pkg::secondary_in_t   secondary;
  logic                     hit_valid, hit_ready;
  lod_pkg::hit_out_t        hit;
  logic                     request_valid, request_ready;
  lod_pkg::memory_request_t request;
  logic                     answer_valid;
  lod_pkg::memory_answer_t  answer;

  // ---- The core under test: yours goes here ----

  traversal_unit core (
    .clk_i      (clk),
    .rst_ni     (rst_n),
    .scene_i    (scene),
    .flush_i    (1'b0),
    .busy_o     (),
    .memory_test_i   ('0),
    .memory_fault_o  (),
    .view_context_i  ('0),
    .view_o          (),
    .counters_clear_i(1'b0),
    .counters_o      (),
    .valid_i    (ray_valid),
    .ready_o    (ray_ready),
    .in_i       (ray),
    .secondary_i(secondary),
    .valid_o    (hit_valid),
    .ready_i    (hit_ready),
    .out_o      (hit),
    .corners_o  (),
    .mem_valid_o(request_valid),
    .mem_ready_i(request_ready),
    .mem_o      (request),
    .mem_valid_i(answer_valid),
    .mem_ready_o(),
    .mem_i      (answer)
  );

  // ---- What was asked for, and what is known of it ----

  chandle      model, golden;
  string       path;
  int unsigned width = 32, latency = 40, seed = 1, broken = '1;
  real         distance = 2.5, delta = 1.0;

  bit [$bits(lod_pkg::hit_out_t)-1:0] expected[int unsigned];
  lod_pkg::memory_request_t           requests[$];
  int unsigned                        due     [$];
  int unsigned cycle = 0, quiet = 0, next = 0, sent = 0, checked = 0, met = 0, wrong = 0;

  task automatic fail(input string what);
    $display("golden_check: %s: %s", what, lodray_dpi_pkg::lodray_last_error());
    $fatal(1);
  endtask

  // The next ray of the picture that meets the model's box goes to the port, and what it must meet to `expected`.
  task automatic offer();
    bit [$bits(lod_pkg::ray_in_t)-1:0]  bits;
    bit [$bits(lod_pkg::hit_out_t)-1:0] wanted;
    int enters;
    enters = 0;
    while (enters == 0 && next < width * width) begin
      enters = lodray_dpi_pkg::lodray_camera_ray_bits(model, distance, delta, width, width, next % width, next / width, bits);
      if (enters < 0) fail("ray");
      next++;
    end
    ray_valid <= enters == 1;
    if (enters == 1) begin
      if (lodray_dpi_pkg::lodray_golden_trace_bits(golden, bits, wanted) < 0) fail("golden");
      ray <= bits;
      expected[next-1] = wanted;
    end
  endtask

  // A hit that the core gives.
  task automatic check(input lod_pkg::hit_out_t given);
    lod_pkg::hit_out_t wanted;
    if (!expected.exists(given.tag)) begin
      $display("a hit of no ray under way: tag %0d", given.tag);
      wrong++;
    end else begin
      wanted = expected[given.tag];
      expected.delete(given.tag);
      if (given !== wanted) begin
        $display("ray %0d: the core is not golden\n  core:   %p\n  golden: %p", given.tag, given, wanted);
        wrong++;
      end
      checked++;
      met += wanted.found ? 1 : 0;
    end
  endtask

  // The line of the oldest request that is due, if one is.
  task automatic serve();
    bit [255:0] line;
    int         found;
    answer_valid <= 1'b0;
    if (due.size() > 0 && due[0] <= cycle) begin
      found = lodray_dpi_pkg::lodray_line_bits(model, longint'(requests[0].address), line);
      if (found < 0) fail("memory");
      answer_valid <= 1'b1;
      answer       <= '{tag: requests[0].tag, epoch: requests[0].epoch, error: found == 0, line: line};
      void'(requests.pop_front());
      void'(due.pop_front());
      quiet = 0;
    end
  endtask

  initial begin
    bit [$bits(lod_pkg::scene_config_t)-1:0] config_bits;
    if ($value$plusargs("scene=%s", path) == 0) begin
      $display("golden_check: +scene=FILE is missing");
      $fatal(1);
    end
    void'($value$plusargs("width=%d", width));
    void'($value$plusargs("distance=%f", distance));
    void'($value$plusargs("delta=%f", delta));
    void'($value$plusargs("latency=%d", latency));
    void'($value$plusargs("seed=%d", seed));
    void'($value$plusargs("break=%d", broken));
    model = lodray_dpi_pkg::lodray_scene_open(path);
    if (model == null) fail("scene");
    golden = lodray_dpi_pkg::lodray_golden_new(model);
    if (golden == null) fail("golden");
    if (lodray_dpi_pkg::lodray_scene_config_bits(model, config_bits) < 0) fail("scene");
    scene = config_bits;
    // A primary ray: every t counts.
    secondary       = '0;
    secondary.t_max = '1;
    void'($urandom(seed));
    ray_valid     = 1'b0;
    answer_valid  = 1'b0;
    hit_ready     = 1'b0;
    request_ready = 1'b0;
    repeat (2) @(posedge clk);
    rst_n <= 1'b1;
  end

  // Everything is looked at as it stood before the edge, and given after it.
  always @(posedge clk) begin : move
    lod_pkg::hit_out_t given;
    if (rst_n) begin
      cycle++;
      quiet++;
      if (hit_valid && hit_ready) begin
        given = hit;
        if (given.tag == broken) given.hit.t ^= 1;
        check(given);
        quiet = 0;
      end
      if (request_valid && request_ready) begin
        requests.push_back(request);
        due.push_back(cycle + $urandom_range(latency, 1));
      end
      serve();
      if (ray_valid && ray_ready) sent++;
      if (!ray_valid || ray_ready) offer();
      // Both stall now and then: a core must not rely on them.
      hit_ready     <= $urandom_range(3) != 0;
      request_ready <= $urandom_range(3) != 0;
      if (next == width * width && !ray_valid && expected.size() == 0) finish();
      if (quiet > PATIENCE) begin
        $display("golden_check: nothing moved for %0d cycles, %0d rays are under way", PATIENCE, expected.size());
        $fatal(1);
      end
    end
  end

  task automatic finish();
    $display("%0d rays, %0d into the core, %0d checked, %0d hits, %0d cycles: %0d differ", width * width, sent, checked, met, cycle, wrong);
    lodray_dpi_pkg::lodray_golden_end(golden);
    lodray_dpi_pkg::lodray_scene_close(model);
    if (wrong != 0 || checked != sent || met == 0) $fatal(1);
    $finish;
  endtask

endmodule

`default_nettype wire
