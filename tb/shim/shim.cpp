// C interface to one verilated top, used by `library.rs`. `ports.h` is generated: it includes the model's header and names its ports.
//
// Ports cross as words of 64 bits, least significant first; Verilator's own port types are the same bytes on a little-endian machine.
// A top with the ports of a block (LODRAY_BLOCK) also gets `lodray_run`, which plays one batch of transactions per call.
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include "ports.h"
#include "verilated.h"
#if VM_COVERAGE
#include "verilated_cov.h"
#endif
#if VM_TRACE
#include "verilated_vcd_c.h"
#endif

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "ports are copied as bytes");

#define EXPORT extern "C" __attribute__((visibility("default")))

namespace {

// Time of one clock cycle in the waveform; the rising edge that ends cycle c is at CYCLE * (c + 1).
constexpr uint64_t CYCLE = 10;

struct Instance {
    VerilatedContext context;
    std::unique_ptr<Vtop> top;
    uint64_t cycle = 0;
    bool settled = false;  // The inputs as they are have been evaluated with the clock low.
#if VM_TRACE
    std::unique_ptr<VerilatedVcdC> vcd;
#endif

    explicit Instance(uint64_t seed) {
        // Registers start with random values: only what is reset may be relied on.
        context.randReset(2);
        context.randSeed(static_cast<int>(seed % 0x7fffffff) + 1);
        context.fatalOnError(false);
#if VM_TRACE
        context.traceEverOn(true);
#endif
        enter();
        top = std::make_unique<Vtop>(&context, "");
        top->clk_i = 0;
    }
    void enter() { Verilated::threadContextp(&context); }
    void dump(uint64_t time) {
#if VM_TRACE
        if (vcd) vcd->dump(time);
#else
        (void)time;
#endif
    }
    void settle() {
        if (settled) return;
        top->eval();
        settled = true;
    }
    // Ends the cycle: outputs stand as of the new one, for the old inputs.
    void clock() {
        settle();
        dump(CYCLE * cycle + CYCLE / 2);
        top->clk_i = 1;
        top->eval();
        ++cycle;
        dump(CYCLE * cycle);
        top->clk_i = 0;
        settled = false;
    }
};

struct Port {
    const char* name;
    uint32_t width;
    uint32_t output;
};

const Port PORTS[] = {
#define X(name, width, output) {#name, width, output},
    LODRAY_PORTS(X)
#undef X
};

// Address and bytes of a port.
void* at(Instance* i, uint32_t port, size_t& bytes) {
    uint32_t n = 0;
#define X(name, width, output)        \
    if (n++ == port) {                \
        bytes = sizeof(i->top->name); \
        return &i->top->name;         \
    }
    LODRAY_PORTS(X)
#undef X
    bytes = 0;
    return nullptr;
}

}  // namespace

EXPORT const Port* lodray_ports(uint32_t* count) {
    *count = sizeof(PORTS) / sizeof(PORTS[0]);
    return PORTS;
}
EXPORT Instance* lodray_new(uint64_t seed) { return new Instance(seed); }
EXPORT void lodray_delete(Instance* i) {
    i->enter();
#if VM_TRACE
    if (i->vcd) i->vcd->close();
#endif
    i->top->final();
    delete i;
}
EXPORT void lodray_poke(Instance* i, uint32_t port, const uint64_t* words) {
    size_t bytes;
    void* p = at(i, port, bytes);
    std::memcpy(p, words, bytes);
    i->settled = false;
}
EXPORT void lodray_peek(Instance* i, uint32_t port, uint64_t* words) {
    size_t bytes;
    const void* p = at(i, port, bytes);
    std::memcpy(words, p, bytes);
}
EXPORT void lodray_eval(Instance* i) {
    i->enter();
    i->settle();
}
EXPORT void lodray_clock(Instance* i) {
    i->enter();
    i->clock();
}
EXPORT uint64_t lodray_cycle(const Instance* i) { return i->cycle; }
EXPORT int lodray_failed(const Instance* i) { return i->context.gotError(); }

#if VM_TRACE
EXPORT int lodray_vcd_open(Instance* i, const char* path) {
    i->enter();
    if (i->vcd) i->vcd->close();
    i->vcd = std::make_unique<VerilatedVcdC>();
    i->top->trace(i->vcd.get(), 99);
    i->vcd->open(path);
    return i->vcd->isOpen();
}
EXPORT void lodray_vcd_close(Instance* i) {
    if (i->vcd) i->vcd->close();
    i->vcd.reset();
}
#endif
#if VM_COVERAGE
EXPORT void lodray_coverage(Instance* i, const char* path) { i->context.coveragep()->write(path); }
#endif

#ifdef LODRAY_BLOCK
namespace {

// SplitMix64.
struct Rng {
    uint64_t state;
    uint64_t next() {
        uint64_t z = (state += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
};

// One side's will to transfer: phases of random length, each free, half closed, almost closed, or closed.
struct Gate {
    Rng rng;
    uint32_t left = 0;
    uint32_t closed = 0;  // Of 16 cycles.
    bool open() {
        static const uint32_t KINDS[] = {0, 0, 8, 15, 16, 4, 0, 12};
        if (left == 0) {
            const uint64_t r = rng.next();
            left = 1 + (r & ((r & 0x100) ? 63 : 7));
            closed = KINDS[(r >> 16) & 7];
        }
        --left;
        return (rng.next() & 15) >= closed;
    }
};

template <class T> void load(T& port, const uint64_t* words) { std::memcpy(&port, words, sizeof(port)); }
template <class T> void store(const T& port, uint64_t* words) { std::memcpy(words, &port, sizeof(port)); }
template <class T> bool same(const T& a, const T& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }
void garbage(void* port, size_t bytes, uint32_t width, Rng& rng) {
    for (uint32_t k = 0; k < bytes; k += 8) {
        uint64_t r = rng.next();
        if (width < 8 * k + 64) r &= (1ull << (width - 8 * k)) - 1;
        std::memcpy(static_cast<char*>(port) + k, &r, bytes - k < 8 ? bytes - k : 8);
    }
}

}  // namespace

enum Violation : uint32_t { NONE, VALID_DROPPED, OUTPUT_CHANGED, UNEXPECTED, TIMEOUT, ASSERTION, COMBINATIONAL };

// One batch; `library.rs` has its twin.
struct Batch {
    const uint64_t* in;    // `count` inputs of `in_stride` words.
    const uint64_t* tags;  // Their tags.
    uint64_t* out;         // The outputs, `out_stride` words each.
    uint64_t* out_tags;
    uint64_t* presented;  // Cycle in which each input was first offered.
    uint64_t* accepted;   // Cycle in which each input was taken.
    uint64_t* offered;    // Cycle in which each output was first offered.
    uint64_t* delivered;  // Cycle in which each output was taken.
    uint64_t in_stride, out_stride, count;
    uint64_t seed;     // Of the stalls.
    uint64_t patience; // Cycles without any transfer that count as stuck.
    uint64_t quiet;    // Cycles watched after the last output.
    uint64_t vcd_from, vcd_to;  // Cycles of the waveform, counted from the start of the batch.
    const char* vcd;   // Its file, or null.
    uint32_t stalled;  // Random stalls on both sides, and work under way when reset comes.
    uint32_t violation;
    uint64_t cycles;    // Cycles after reset.
    uint64_t received;  // Outputs taken.
};

EXPORT void lodray_run(Instance* i, Batch* b) {
    i->enter();
    Vtop& top = *i->top;
    Rng rng{b->seed};
    Gate in_gate{{rng.next()}}, out_gate{{rng.next()}};

    b->violation = NONE;
    b->received = 0;
    // Work under way is forgotten at reset.
    const uint64_t before = b->stalled ? rng.next() & 63 : 0;
    top.rst_ni = 1;
    for (uint64_t c = 0; c < before; ++c) {
        const uint64_t k = c % b->count;
        top.valid_i = in_gate.open();
        top.ready_i = out_gate.open();
        load(top.in_i, b->in + k * b->in_stride);
        load(top.tag_i, b->tags + k);
        i->settled = false;
        i->clock();
    }
    top.rst_ni = 0;
    top.valid_i = 0;
    top.ready_i = 0;
    i->settled = false;
    i->clock();
    top.rst_ni = 1;

    const uint64_t first = i->cycle;
    uint64_t sent = 0, shown = 0, idle = 0, quiet = 0;
    bool offering = false;  // An input stands at the port and was not taken yet.
    bool held = false;      // An output was offered and not taken.
    auto held_out = top.out_o;
    auto held_tag = top.tag_o;
    for (;; i->clock()) {
        const uint64_t cycle = i->cycle - first;
#if VM_TRACE
        if (b->vcd && cycle == b->vcd_from) lodray_vcd_open(i, b->vcd);
        if (b->vcd && cycle == b->vcd_to) lodray_vcd_close(i);
#endif
        b->cycles = cycle;
        if (i->context.gotError()) {
            b->violation = ASSERTION;
            break;
        }
        // Outputs come from registers: what stands here before the inputs of this cycle must stand after them too.
        const auto early_valid = top.valid_o;
        const auto early_out = top.out_o;
        const auto early_tag = top.tag_o;

        if (!offering && sent < b->count && (!b->stalled || in_gate.open())) {
            offering = true;
            b->presented[sent] = cycle;
        }
        top.valid_i = offering;
        if (offering) {
            load(top.in_i, b->in + sent * b->in_stride);
            load(top.tag_i, b->tags + sent);
        } else if (b->stalled) {
            garbage(&top.in_i, sizeof(top.in_i), LODRAY_IN_W, rng);
            garbage(&top.tag_i, sizeof(top.tag_i), LODRAY_TAG_W, rng);
        }
        top.ready_i = b->received == b->count || !b->stalled || out_gate.open();
        i->settled = false;
        i->settle();

        if (top.valid_o != early_valid || (top.valid_o && !(same(top.out_o, early_out) && same(top.tag_o, early_tag)))) {
            b->violation = COMBINATIONAL;
            break;
        }
        if (held && !top.valid_o) {
            b->violation = VALID_DROPPED;
            break;
        }
        if (held && !(same(top.out_o, held_out) && same(top.tag_o, held_tag))) {
            b->violation = OUTPUT_CHANGED;
            break;
        }
        bool moved = false;
        if (top.valid_o) {
            if (b->received == sent) {
                b->violation = UNEXPECTED;
                break;
            }
            if (shown == b->received) b->offered[shown++] = cycle;
            held = !top.ready_i;
            if (held) {
                held_out = top.out_o;
                held_tag = top.tag_o;
            } else {
                store(top.out_o, b->out + b->received * b->out_stride);
                b->out_tags[b->received] = 0;
                store(top.tag_o, b->out_tags + b->received);
                b->delivered[b->received] = cycle;
                ++b->received;
                moved = true;
            }
        }
        if (offering && top.ready_o) {
            b->accepted[sent++] = cycle;
            offering = false;
            moved = true;
        }
        if (b->received == b->count && ++quiet > b->quiet) break;
        idle = moved ? 0 : idle + 1;
        if (idle > b->patience) {
            b->violation = TIMEOUT;
            break;
        }
    }
#if VM_TRACE
    if (b->vcd) {
        i->clock();
        lodray_vcd_close(i);
    }
#endif
}
#endif
