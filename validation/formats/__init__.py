"""A report as other programs and people read it: JUnit, SARIF and HTML."""
