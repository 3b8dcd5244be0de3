from .api import (
    add_effect as add_effect,
)
from .api import (
    compare as compare,
)
from .api import (
    compensate as compensate,
)
from .api import (
    diagnose as diagnose,
)
from .api import (
    discover as discover,
)
from .api import (
    discover_all as discover_all,
)
from .api import (
    draft_effect as draft_effect,
)
from .api import (
    measure as measure,
)
from .api import (
    plan_next_test as plan_next_test,
)
from .api import (
    predict as predict,
)
from .api import (
    preview_effect as preview_effect,
)
from .api import (
    propose_plan as propose_plan,
)
from .api import (
    rank_contributions as rank_contributions,
)
from .api import (
    remove_effect as remove_effect,
)
from .api import (
    report as report,
)
from .api import (
    simulated_rig as simulated_rig,
)
from .effects import effect as effect
from .effects import load_effects as load_effects
from .errors import HexdbbError as HexdbbError
from .errors import InputError as InputError
from .errors import RunError as RunError
from .importing import read_record as read_record
from .ledger import history as history
from .ledger import undo as undo
from .machine import load_machine as load_machine
from .machine import shipped_machine as shipped_machine
from .model import (
    Model as Model,
)
from .model import (
    effect_info as effect_info,
)
from .model import (
    effect_names as effect_names,
)
from .model import (
    load_model as load_model,
)
from .model import (
    new_model as new_model,
)
from .model import (
    save_model as save_model,
)
from .model import (
    switched_off as switched_off,
)
from .model import (
    with_value as with_value,
)
from .plan import Plan as Plan
from .plan import load_plan as load_plan
from .plan import save_plan as save_plan
from .plan import shipped_plans as shipped_plans
from .record import Record as Record
from .record import write_record as write_record
from .samples import Samples as Samples

__version__: str
