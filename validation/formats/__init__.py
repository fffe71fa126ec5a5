"""A report as other programs and people read it: JSON, JUnit, SARIF and HTML."""
