"""Effects of a user's own, and the handbook of all effects.

A user's effect is a function of the samples (`hexdbb.samples.Samples`), decorated with what it pushes and in what unit;
in a file named on the command line:

    import numpy as np
    from hexdbb.effects import effect

    @effect(port="slider", unit="mm", prior_sigma=0.01, elements=6)
    def dent(samples):
        '''A dent in the guideway, 400 mm from its vertex, as long as a carriage.'''
        return np.exp(-(((samples["sliders_mm"] - 400.0) / 15.0) ** 2))

Where the dent lies may be fitted too:

    @effect(port="slider", unit="mm", prior_sigma=0.01, elements=6, shapes={"centre": Shape(400.0, prior_sigma=50.0)})
    def dent(samples, centre):
        return np.exp(-(((samples["sliders_mm"] - centre) / 15.0) ** 2))
"""

from hexdbb.effects.draft import draft
from hexdbb.effects.loading import load_effects
from hexdbb.effects.same import same_effects
from hexdbb.effects.tabulate import UserEffectError
from hexdbb.effects.user import UserEffect, effect
from hexdbb.model import Shape

__all__ = [
    "Shape",
    "UserEffect",
    "UserEffectError",
    "draft",
    "effect",
    "load_effects",
    "same_effects",
]
