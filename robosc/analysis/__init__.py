"""What is asked of a supervised system: its findings, why something can not happen, and proofs."""
