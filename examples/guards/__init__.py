"""Twelve guards: small models for the supervisory layer, with worlds and judges."""
