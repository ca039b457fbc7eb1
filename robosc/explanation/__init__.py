"""Why an event is forbidden, an event never happens, or a supervisor is empty, in the model's own words."""
