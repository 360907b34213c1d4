"""Runs unittest cases and ends with the line that tests/run reads: `N passed, N failed, N skipped`."""

import sys
import unittest


def run(suite, verbosity=1):
    """Runs the suite, prints the totals, returns the exit status."""
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=verbosity).run(suite)
    # A case whose sub-tests fail is one failure.
    broken = [case for case, _ in result.failures + result.errors] + result.unexpectedSuccesses
    failed = len({getattr(case, "test_case", case).id() for case in broken})
    passed = result.testsRun - failed - len(result.skipped)
    for case, reason in result.skipped:
        print(f"skipped: {case}: {reason}")
    print(f"{max(passed, 0)} passed, {failed} failed, {len(result.skipped)} skipped")
    return 1 if failed else 0
