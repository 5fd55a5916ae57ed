"""What tests of the page in a real browser have in common."""

SIX_THREE = "workspace-6-3"
FACTS = "document.querySelector('.gsp-facts')?.innerText"
TEXT = "document.body.innerText"
