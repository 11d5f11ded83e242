from .functions import frequency_response as frequency_response
from .response import Response as Response, response as response
