"""From failed checks to another choice: infer, simulate, feed back, choose again."""
