"""Pictures of comparisons, diagnoses and discoveries: polar plots, residuals against angle, the forms of causes.

::

    pages = comparison_pages(comparison)  # what matters first is the first
    save_figure(pages[0].draw(), Path("demo-compare"))
    save_pdf((page.draw() for page in pages), Path("demo-compare.pdf"))

Each function is loaded when it is first used: pictures of trends need SciPy, those of a comparison do not.
"""

import lazy_loader as _lazy

# The names stand in __init__.pyi, once for type checkers and for loading.
__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
