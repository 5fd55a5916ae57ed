"""All assembly modes of a hexapod with given leg lengths."""

import gsp

design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
modes = gsp.assembly_modes(design, design.at(design.home).joints)
figure = gsp.plots.assembly_modes(design, modes)
figure.savefig("assembly_modes.png", dpi=120)
