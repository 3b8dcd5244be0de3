"""hexdbb: why a HexGlider parallel manipulator does not go where it is told, by a double-ball-bar circular test.

The functions a user needs, each loaded when it is first used::

    import hexdbb as hx

    record = hx.measure("standard", "today.parquet")          # or hx.read_record("monday.parquet")
    found = hx.diagnose(record, hx.new_model(record.machine))
    print(hx.compare(record, found.model))                    # where does the model fail?
    print(hx.discover(record, found.model))                   # which physical effect is missing?
    found = hx.add_effect(record, found.model, "backlash:4")  # add it, and watch the error fall
    hx.save_model(found.model, "model.toml")

====================  ==================================================================================================
measure               `measure`, `simulated_rig`, `Plan`, `load_plan`, `shipped_plans`, `load_machine`,
                      `shipped_machine`
records               `read_record`, `write_record`, `Record`; `Samples.of(records)` is the table that all below take
models                `new_model`, `load_model`, `save_model`, `Model`, `effect_names`, `effect_info`
why does it err       `diagnose`, `predict`, `compare`, `discover`, `discover_all`
what is missing       `add_effect`, `remove_effect`, `undo`, `history`; an effect of your own: `effect`,
                      `load_effects`, `draft_effect`
what if               `preview_effect`, `switched_off`, `with_value`: models to predict with, not kept
to hand over          `report`, `rank_contributions`
what follows          `compensate`, `propose_plan`, `plan_next_test`, `save_plan`
errors                `HexdbbError`: `InputError` (bad input), `RunError` (what failed while running)
====================  ==================================================================================================

Units inside: mm, rad, s, N; the unit is part of every name. Terms: docs/glossary.md; packages: docs/architecture.md.
"""

import lazy_loader as _lazy

# The names stand in __init__.pyi, once for type checkers and for loading.
_load, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)


def __getattr__(name: str) -> object:
    """Load a name when it is first used; to look the version up takes as long as several of them."""
    if name != "__version__":
        return _load(name)
    from importlib.metadata import version

    globals()[name] = version("hexdbb")
    return globals()[name]
