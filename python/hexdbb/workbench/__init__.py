"""The workbench: a local page in which a model is seen, tried, extended and taken back.

=============  =========================================================================================================
showing        what is shown of records and a model, and what is tried on it
session        `Session`: records, a model, and actions that call what the commands call; every one is a line of Python
outputs        files that a session writes beside the model
page           what the browser shows of a session; the only modules that import NiceGUI
server         the page served to this computer alone: loopback, a token, origin and host checked
=============  =========================================================================================================
"""

from hexdbb.workbench.session import Session

__all__ = ["Session"]
