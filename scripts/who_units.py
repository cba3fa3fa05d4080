"""By units: what compute that takes time does to the views of docs/who-wins.md, of each method at the settings that are cheapest with compute free (`lodray simulate --compute units`)."""

import statistics

from keep import kept, knobs
from markdown import among, table

# Errors whose rows are shown; of all errors winners are counted.
SHOWN = [("surface", 0.25), ("surface", 1), ("flip", 0.01), ("flip", 0.05)]
# Methods some of whose operations no block does: they take no time.
PARTLY = ["grid", "cluster", "cluster-paper", "rlod"]


def run(args, file, view, machine, point):
    """A setting by units: milliseconds and energy."""
    found = kept(args, ["--quiet", "simulate", file, *view, "--size", args.size, "--machine", machine, "--compute", "units", "--method", point["method"], *knobs(point)])
    return found["milliseconds"], found["energy"]["total"]


def measured(args, files, places, views, best, errors):
    """By view and error that limits something (`best` gives settings): of each method, or none where it cannot, its setting and its costs, time with compute free, and time and energy by units."""
    cases = {}
    for (name, place, machine), points in views.items():
        for kind, levels in errors.items():
            for level in levels:
                settings = best(points, kind, level)
                if settings is None:
                    continue
                of = cases.setdefault((name, place, machine, kind, level), {})
                for method, point in settings.items():
                    of[method] = point and (point, (point["cost"]["milliseconds"], *run(args, files[name], places[name, place], machine, point)))
    return cases


def winners(cases, methods, machine, cost):
    """How often each method is cheapest on a machine."""
    won = dict.fromkeys(methods, 0)
    for (_, _, called, *_), of in cases.items():
        reached = {method: found[1][cost] for method, found in of.items() if found and method in methods}
        if called == machine and reached:
            won[min(reached, key=lambda method: (reached[method], methods.index(method)))] += 1
    return won


def how_often(cases, methods, columns):
    """A table: how often each of `methods` is cheapest among them."""
    won = [winners(cases, methods, *of) for of in columns.values()]
    return table(["cheapest", *columns], [[f"`{method}`", *(f"{of[method]} of {sum(of.values())}" for of in won)] for method in methods], 1)


def close(cases, methods, machine):
    """In how many cases of a machine the fastest leads by less than a fiftieth, and in how many of those it is ours."""
    cases = [sorted((found[1][1], methods.index(method)) for method, found in of.items() if found) for (_, _, called, *_), of in cases.items() if called == machine]
    led = [of[0][1] for of in cases if len(of) > 1 and of[1][0] < of[0][0] * 1.02]
    return f"on `{machine}` in {len(led)} of {len(cases)} cases, of which {led.count(methods.index('lod'))} are ours"


def by_units(cases, methods, errors):
    """Three tables: who is cheapest how often, of all and of those whose every operation has a block, and medians over ours."""
    machines = list(dict.fromkeys(case[2] for case in cases))
    whats = {"time, compute free": 0, "time": 1, "energy": 2}
    columns = {f"{what}, {machine}": (machine, cost) for machine in machines for what, cost in whats.items()}
    rows = []
    for kind, level in SHOWN:
        for method in methods[1:]:
            cells = []
            for machine in machines:
                pairs = [(of[method], of["lod"]) for (_, _, called, *error), of in cases.items() if called == machine and error == [kind, level] and of.get(method) and of.get("lod")]
                for cost in whats.values():
                    ratios = [own[1][cost] / ours[1][cost] for own, ours in pairs]
                    cells.append(f"{statistics.median(ratios):.2f} ({among(ratios)})" if ratios else "cannot")
            rows.append([f"{errors[kind]} {level:g}", f"`{method}`", *cells])
    whole = [method for method in methods if method not in PARTLY]
    over_ours = table(["at most", "method over ours, median (least to most)", *columns], rows, 2)
    leads = "The fastest leads by less than 2 % " + ", ".join(close(cases, methods, machine) for machine in machines) + "."
    return "\n\n".join([how_often(cases, methods, columns), leads, "Of methods whose every operation has a block:", how_often(cases, whole, columns), over_ours])


def lines(cases, named):
    """All of it, as lines of CSV."""
    yield ["scene", "radii", "machine", "error", "at most", "method", "setting", "ms, compute free", "ms", "uJ"]
    for case, of in cases.items():
        for method, found in of.items():
            setting = named(found[0]) if found else "cannot"
            yield [*case, method, setting, *(f"{cost:.6g}" for cost in (found[1] if found else ()))]
