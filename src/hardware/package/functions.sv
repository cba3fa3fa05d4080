
  // Bit k: stage k of the box tests is a `pipe_skid`. Two registers follow it.
  localparam logic [63:0] BOX_TEST_SKIDS = 64'd1 << (BOX_TEST_LATENCY - 3);
  localparam logic [63:0] BOX_TEST32_SKIDS = 64'd1 << (BOX_TEST32_LATENCY - 3);

  // Limbs of a factor of `multiplier`.
  function automatic int unsigned multiplier_limbs(input int unsigned w);
    multiplier_limbs = w <= MULTIPLIER_LIMB_W + 1 ? 1 : (w - 1 + MULTIPLIER_LIMB_W - 1) / MULTIPLIER_LIMB_W;
  endfunction

  // Cycles of `multiplier`: the limb products, then one tree level each.
  function automatic int unsigned multiplier_latency(input int unsigned a_w, input int unsigned b_w);
    multiplier_latency = 1 + $clog2(multiplier_limbs(a_w)) + $clog2(multiplier_limbs(b_w));
  endfunction

  // Cycles of `dot_product`: factors, products, two sums; of `cross_product`: factors, products in EDGE_PRODUCT_STAGES, differences.
  function automatic int unsigned dot_product_latency(input int unsigned a_w, input int unsigned b_w);
    dot_product_latency = 1 + multiplier_latency(a_w, b_w) + 2;
  endfunction
  function automatic int unsigned cross_product_latency(input int unsigned w);
    cross_product_latency = 1 + EDGE_PRODUCT_STAGES - 1 + multiplier_latency(w, w) + 1;
  endfunction
