from .analysis_pages import (
    diagnosis_pages as diagnosis_pages,
)
from .analysis_pages import (
    discovery_pages as discovery_pages,
)
from .learned import (
    learned_figure as learned_figure,
)
from .pages import (
    comparison_pages as comparison_pages,
)
from .residual_circles import (
    residual_figure as residual_figure,
)
from .saving import (
    Page as Page,
)
from .saving import (
    save_figure as save_figure,
)
from .saving import (
    save_pages as save_pages,
)
from .saving import (
    save_pdf as save_pdf,
)
from .trend import (
    trend_effects_figure as trend_effects_figure,
)
from .trend import (
    trend_figure as trend_figure,
)
