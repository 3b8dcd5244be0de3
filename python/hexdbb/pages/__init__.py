"""Pages of this computer's browser: who may open one, how it is served, how it looks.

=============  =========================================================================================================
guard          loopback, a token, origin and host checked
serving        a page served until its process ends; the only module here that imports NiceGUI
=============  =========================================================================================================
"""

MISSING = "NiceGUI is not installed (expected: pip install 'hexdbb[workbench]')"
"""Why a page cannot be opened, for an error."""
