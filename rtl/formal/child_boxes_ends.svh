  // Inside child_boxes: the smallest floor and the largest ceiling of each child's corners, of its full-resolution triangle and of its morphed one; the former are the origin for
  // a quad-BVH node.
  localparam int unsigned P_W = lod_pkg::POINT_W;
  localparam logic signed [31:0] LIMIT = 32'sh7ffe_0000;

  // Corners of the four children (docs/numbers.md).
  logic [3:0][3*P_W-1:0] full, morphed;
  assign full    = {in_i.g0, in_i.g1, in_i.g2, in_i.g1, in_i.g0, in_i.f2, in_i.g2, in_i.f1, in_i.g0, in_i.f0, in_i.g2, in_i.g1};
  assign morphed = {in_i.q0, in_i.q1, in_i.q2, in_i.q1, in_i.q0, in_i.p2, in_i.q2, in_i.p1, in_i.q0, in_i.p0, in_i.q2, in_i.q1};

  logic [23:0] legal, low_exact, high_exact;
  for (genvar i = 0; i < 24; i++) begin : g_formal
    localparam int unsigned AT = i % 12;
    localparam int unsigned FROM = (2 - i % 3) * 32;
    logic [3*P_W-1:0]           corners;
    logic signed [31:0]         a, b, c;
    logic signed [CODE_W-1:0]   framed, got_low, high_floor;
    logic signed [EXACT_W-1:0]  got_high;
    // In codes, with room: floors, ceilings.
    logic signed [CODE_W+1:0]   fa, fb, fc, ca, cb, cc, low_is, high_is;
    logic                       node;
    assign corners = i < 12 ? full[AT/3] : morphed[AT/3];
    assign {a, b, c}    = {corners[2*P_W+FROM +: 32], corners[P_W+FROM +: 32], corners[FROM +: 32]};
    assign {fa, fb, fc} = {(CODE_W+2)'(a >>> 16), (CODE_W+2)'(b >>> 16), (CODE_W+2)'(c >>> 16)};
    assign {ca, cb, cc} = {fa + (CODE_W+2)'(a[15:0] != '0), fb + (CODE_W+2)'(b[15:0] != '0), fc + (CODE_W+2)'(c[15:0] != '0)};
    assign framed       = origin[i%3];
    assign got_low      = i < 12 ? full_low[AT] : low[AT];
    assign got_high     = i < 12 ? full_high[AT] : {high[AT], 1'b0};
    assign high_floor   = got_high[EXACT_W-1:1];
    assign low_is       = (CODE_W+2)'(got_low);
    assign high_is      = (CODE_W+2)'(high_floor) + (CODE_W+2)'(got_high[0]);
    assign node         = i < 12 && !in_i.tree;
    assign legal[i]     = a <= LIMIT && a >= -LIMIT && b <= LIMIT && b >= -LIMIT && c <= LIMIT && c >= -LIMIT;
    assign low_exact[i] = node ? low_is == (CODE_W+2)'(framed)
      : low_is <= fa && low_is <= fb && low_is <= fc && (low_is == fa || low_is == fb || low_is == fc);
    assign high_exact[i] = node ? high_is == (CODE_W+2)'(framed) && !got_high[0]
      : high_is >= ca && high_is >= cb && high_is >= cc && (high_is == ca || high_is == cb || high_is == cc);
  end

  for (genvar i = 0; i < 24; i++) begin : g_proved
    always_comb begin
      assert (low_exact[i]);
      assert (high_exact[i]);
    end
  end
  always_comb begin
    assume (legal == '1);
    cover (in_i.tree && in_i.p0.x == LIMIT && high[0] == CODE_W'(32766) && low[0] == -CODE_W'(32766));
    cover (in_i.tree && full_low[9] == CODE_W'(7) && full_high[9] == EXACT_W'(17) && in_i.g0.x != in_i.g1.x);
    cover (!in_i.tree && full_low[4] == -CODE_W'(32767));
  end

