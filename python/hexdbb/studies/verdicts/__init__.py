"""How often verdicts are right: machines with faults whose forms are their own, judged and compared with the truth.

Faults are those of `hexdbb_truth.forms`: of the catalogue's kinds, their formulas off by 0 to 20 %; with the true
effect withheld from the candidates; of kinds that the catalogue has not; two and three at once; none.
"""

from hexdbb.studies.study import Study
from hexdbb.studies.verdicts.cases import COLUMNS, cases, row
from hexdbb.studies.verdicts.result import page_of_rows, result

STUDY = Study("verdicts", "How often is a verdict right?", COLUMNS, cases, row, result, page_of_rows)

__all__ = ["STUDY"]
