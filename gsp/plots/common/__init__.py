"""What several figures share: axes and colours, scales, columns of tables, drawn bodies."""
