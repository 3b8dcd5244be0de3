"""The page that watches a run: a process of its own that `hexdbb-run --watch` starts and tells what happens.

=============  =========================================================================================================
seen           what was told so far (`hexdbb.capture.observation`), kept in memory of bounded size
histogram      cycle times as bars and in words
page           what the browser shows of it, and the stop button; with serving, all that imports NiceGUI
__main__       reads the messages, serves the page, ends some time after the run
=============  =========================================================================================================
"""
