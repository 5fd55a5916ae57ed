"""Constraints, legs, mechanisms, designs and postures: the row-vector assembler."""
