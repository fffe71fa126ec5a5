"""The whole inference, and the folder that it writes."""
