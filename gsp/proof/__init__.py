"""Proofs over boxes of poses: certificates, bounds, distances to singular poses."""

from gsp.proof.around import LargestAround, largest_around
from gsp.proof.boxes import certify
from gsp.proof.certificate import Certificate
from gsp.proof.distance import SingularityDistance, singularity_distance
from gsp.proof.extremes import Bounds, bounds
from gsp.proof.largest import LargestBox, largest_box
from gsp.proof.maximum import CertifiedMaximum, certify_maximum
from gsp.proof.paths import PathCertificate, certify_path
from gsp.proof.reading import read_certificate
from gsp.proof.tolerances import Tolerances
from gsp.proof.worst_values import worst

__all__ = [
    "Bounds",
    "Certificate",
    "CertifiedMaximum",
    "LargestAround",
    "LargestBox",
    "PathCertificate",
    "SingularityDistance",
    "Tolerances",
    "bounds",
    "certify",
    "certify_maximum",
    "certify_path",
    "largest_around",
    "largest_box",
    "read_certificate",
    "singularity_distance",
    "worst",
]
