"""Pages tested in a real browser: Debian's Chromium, headless, driven by Playwright; axe-core judges accessibility.

::

    from tests.browser.chromium import browser, opened, violations  # `browser` is a fixture of the module

    def test_page(browser: Browser) -> None:
        with opened(browser, "file:///tmp/report.html", width=390) as page:  # fails on a console error at the end
            assert violations(page) == []
"""
