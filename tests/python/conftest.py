"""The browser of the tests of pages: one for the tests of a file, whose pages are closed after each test."""

import pytest

import studio_page

TEST_S = 240.0
"""So long a test may take: beyond it the browser is killed, so that calls which wait for it fail. The longest takes 30 s."""


@pytest.fixture(scope="module")
def browser_of_file():
    with studio_page.browser() as browser:
        yield browser


@pytest.fixture
def browser(browser_of_file):
    with studio_page.killed_after(TEST_S):
        yield browser_of_file
        for context in browser_of_file.contexts:
            context.close()
